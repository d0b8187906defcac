#include "pose_graph/graph/minimizer.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

using Eigen::VectorXd;

/// Makes steps and learns from how they fared.
class StepPolicy {
 public:
  virtual ~StepPolicy() = default;
  /// The next step; `relinearized`: the estimate has moved since the last one. False where the
  /// equations have no solution.
  virtual bool step(LeastSquaresProblem* problem, bool relinearized, VectorXd* step) = 0;
  /// `gain`: fall of the cost by that which the linearization promised. True: take the step.
  virtual bool judge(double gain) = 0;
  virtual double restraint() const = 0;
};

class GaussNewton : public StepPolicy {
 public:
  bool step(LeastSquaresProblem* problem, bool /*relinearized*/, VectorXd* step) override {
    return problem->solve(0.0, step);
  }
  bool judge(double /*gain*/) override { return true; }
  double restraint() const override { return 0.0; }
};

class LevenbergMarquardt : public StepPolicy {
 public:
  explicit LevenbergMarquardt(double damping) : damping_(damping) {}

  bool step(LeastSquaresProblem* problem, bool /*relinearized*/, VectorXd* step) override {
    constexpr double kHighestDamping = 1e16;
    while (!problem->solve(damping_, step)) {
      if (!(damping_ < kHighestDamping)) return false;
      judge(-1.0);
    }
    return true;
  }
  bool judge(double gain) override {
    if (gain > 0.0) {
      const double fall = std::pow(2.0 * gain - 1.0, 3);
      damping_ *= std::max(1.0 / 3.0, 1.0 - fall);
      growth_ = 2.0;
      return true;
    }
    damping_ *= growth_;
    growth_ *= 2.0;
    return false;
  }
  double restraint() const override { return damping_; }

 private:
  double damping_;
  double growth_ = 2.0;
};

/// In scaled variables y = D^1/2 x, D = diag(H), in which the trust region is a ball.
class Dogleg : public StepPolicy {
 public:
  bool step(LeastSquaresProblem* problem, bool relinearized, VectorXd* step) override {
    if (relinearized && !makeLegs(problem)) return false;
    if (radius_ < 0.0) radius_ = newton_.norm();
    *step = blend().cwiseQuotient(scale_);
    length_ = std::min(radius_, newton_.norm());
    return true;
  }
  bool judge(double gain) override {
    // Madsen, Nielsen, Tingleff, equation 3.21 and below: a good model earns a wider region.
    if (gain > 0.75) radius_ = std::max(radius_, 3.0 * length_);
    if (!(gain >= 0.25)) radius_ = 0.5 * length_;
    return gain > 0.0;
  }
  double restraint() const override { return radius_; }

 private:
  bool makeLegs(LeastSquaresProblem* problem) {
    scale_ = problem->diagonal().cwiseMax(1e-12).cwiseSqrt();
    const VectorXd gradient = problem->gradient().cwiseQuotient(scale_);
    VectorXd newton;
    if (!problem->solve(0.0, &newton)) return false;
    newton_ = newton.cwiseProduct(scale_);
    const double curvature = problem->curvature(gradient.cwiseQuotient(scale_));
    const double along = curvature > 0.0 ? gradient.squaredNorm() / curvature : 0.0;
    cauchy_ = -along * gradient;
    return true;
  }

  /// The point of the path start - Cauchy - Newton that lies on the region's edge.
  VectorXd blend() const {
    if (newton_.norm() <= radius_) return newton_;
    if (cauchy_.norm() >= radius_) return cauchy_ * (radius_ / cauchy_.norm());
    const VectorXd leg = newton_ - cauchy_;
    const double a = leg.squaredNorm(), b = cauchy_.dot(leg);
    const double c = radius_ * radius_ - cauchy_.squaredNorm();
    const double root = std::sqrt(b * b + a * c);
    const double share = b > 0.0 ? c / (b + root) : (root - b) / a;
    return cauchy_ + share * leg;
  }

  VectorXd scale_, newton_, cauchy_;
  double radius_ = -1.0;  // the first step is Newton's
  double length_ = 0.0;
};

std::unique_ptr<StepPolicy> makePolicy(const MinimizerOptions& options) {
  switch (options.method) {
    case MinimizerMethod::kGaussNewton:
      return std::make_unique<GaussNewton>();
    case MinimizerMethod::kDogleg:
      return std::make_unique<Dogleg>();
    case MinimizerMethod::kLevenbergMarquardt:
      break;
  }
  return std::make_unique<LevenbergMarquardt>(options.initial_damping);
}

/// The loop's state: the problem, and what is known of its current estimate.
class Minimization {
 public:
  Minimization(LeastSquaresProblem* problem, const MinimizerOptions& options)
      : problem_(problem), options_(options), policy_(makePolicy(options)) {}

  MinimizerSummary run() {
    cost_ = summary_.initial_cost = summary_.final_cost = problem_->linearize();
    report(VectorXd::Zero(1), true);
    summary_.status = MinimizerStatus::kOutOfIterations;
    if (!std::isfinite(cost_)) return fail();
    // Nothing to gain: a graph that agrees with itself, or one without unknowns.
    if (problem_->gradient().size() == 0 || problem_->gradient().isZero(0.0)) return converge();
    while (summary_.iterations < options_.max_iterations) {
      VectorXd step;
      if (!policy_->step(problem_, relinearized_, &step)) return fail();
      ++summary_.iterations;
      if (take(step)) return converge();
      if (!std::isfinite(cost_)) return fail();
    }
    return summary_;
  }

 private:
  /// True when there is nothing more to gain.
  bool take(const VectorXd& step) {
    const double trial = problem_->tryStep(step);
    const double promised = -problem_->gradient().dot(step) - 0.5 * problem_->curvature(step);
    const double gain = promised > 0.0 ? (cost_ - trial) / promised : -1.0;
    const double before = cost_;
    relinearized_ = policy_->judge(gain);
    if (relinearized_) {
      problem_->acceptTrial();
      cost_ = summary_.final_cost = std::isfinite(trial) ? problem_->linearize() : trial;
    }
    report(step, relinearized_);
    // What a step promises, not what it gave: a step that overshoots to where the cost is flat
    // gives little, and promises much.
    return promised <= options_.cost_tolerance * before + options_.cost_floor;
  }

  void report(const VectorXd& step, bool accepted) const {
    if (!options_.on_iteration) return;
    options_.on_iteration(
        {summary_.iterations, cost_, step.norm(), policy_->restraint(), accepted});
  }
  MinimizerSummary fail() {
    summary_.status = MinimizerStatus::kFailed;
    return summary_;
  }
  MinimizerSummary converge() {
    summary_.status = MinimizerStatus::kConverged;
    return summary_;
  }

  LeastSquaresProblem* problem_;
  const MinimizerOptions& options_;
  std::unique_ptr<StepPolicy> policy_;
  MinimizerSummary summary_;
  double cost_ = 0.0;
  bool relinearized_ = true;
};

}  // namespace

void MinimizerOptions::validate() const {
  requireWithin("minimizer", "max_iterations", max_iterations, {0, 100000});
  requireWithin("minimizer", "cost_tolerance", cost_tolerance, {0, 1});
  requireWithin("minimizer", "cost_floor", cost_floor, {0, 1});
  requireWithin("minimizer", "initial_damping", initial_damping, {1e-16, 1e6});
}

MinimizerSummary minimize(LeastSquaresProblem* problem, const MinimizerOptions& options) {
  return Minimization(problem, options).run();
}

}  // namespace vins::pose_graph
