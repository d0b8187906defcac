#include "pose_graph/graph/minimizer.h"

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A dense problem of two unknowns.
class DenseProblem : public LeastSquaresProblem {
 public:
  explicit DenseProblem(const Eigen::Vector2d& start) : x_(start) {}
  virtual VectorXd error(const VectorXd& x) const = 0;
  virtual MatrixXd jacobian(const VectorXd& x) const = 0;

  double linearize() override {
    const VectorXd r = error(x_);
    const MatrixXd J = jacobian(x_);
    H_ = J.transpose() * J;
    g_ = J.transpose() * r;
    return 0.5 * r.squaredNorm();
  }
  const VectorXd& gradient() const override { return g_; }
  VectorXd diagonal() const override { return H_.diagonal(); }
  double curvature(const VectorXd& x) const override { return x.dot(H_ * x); }
  bool solve(double damping, VectorXd* step) override {
    MatrixXd damped = H_;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::LLT<MatrixXd> llt(damped);
    if (llt.info() != Eigen::Success) return false;
    *step = -llt.solve(g_);
    return true;
  }
  double tryStep(const VectorXd& step) override {
    trial_ = x_ + step;
    return 0.5 * error(trial_).squaredNorm();
  }
  void acceptTrial() override { x_ = trial_; }

  const VectorXd& x() const { return x_; }

 private:
  VectorXd x_, trial_, g_;
  MatrixXd H_;
};

/// H. H. Rosenbrock's valley, 1960: minimum 0 at (1, 1).
class Rosenbrock : public DenseProblem {
 public:
  using DenseProblem::DenseProblem;
  VectorXd error(const VectorXd& x) const override {
    return Eigen::Vector2d(10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]);
  }
  MatrixXd jacobian(const VectorXd& x) const override {
    return (Eigen::Matrix2d() << -20.0 * x[0], 10.0, -1.0, 0.0).finished();
  }
};

/// arctan(4 x): full Gauss-Newton steps from afar overshoot farther each time.
class Overshooting : public DenseProblem {
 public:
  using DenseProblem::DenseProblem;
  VectorXd error(const VectorXd& x) const override { return (4.0 * x).array().atan().matrix(); }
  MatrixXd jacobian(const VectorXd& x) const override {
    return (4.0 / (1.0 + 16.0 * x.array().square())).matrix().asDiagonal();
  }
};

MinimizerOptions with(MinimizerMethod method) {
  MinimizerOptions options;
  options.method = method;
  return options;
}

TEST(Minimizer, EveryMethodFindsTheEndOfTheValley) {
  for (const MinimizerMethod method :
       {MinimizerMethod::kGaussNewton, MinimizerMethod::kLevenbergMarquardt,
        MinimizerMethod::kDogleg}) {
    Rosenbrock problem({-1.2, 1.0});
    const MinimizerSummary summary = minimize(&problem, with(method));
    EXPECT_EQ(summary.status, MinimizerStatus::kConverged);
    EXPECT_DOUBLE_EQ(summary.initial_cost, 12.1);
    // Steps end when they change the cost by less than a share of 1e-10: then it is rounding.
    EXPECT_LT((problem.x() - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-6);
  }
}

TEST(Minimizer, RestrainedMethodsNeverRaiseTheCost) {
  for (const MinimizerMethod method :
       {MinimizerMethod::kLevenbergMarquardt, MinimizerMethod::kDogleg}) {
    Overshooting problem({5.0, -3.0});
    MinimizerOptions options = with(method);
    std::vector<IterationReport> reports;
    options.on_iteration = [&](const IterationReport& report) { reports.push_back(report); };
    const MinimizerSummary summary = minimize(&problem, options);
    EXPECT_EQ(summary.status, MinimizerStatus::kConverged);
    EXPECT_LT(problem.x().norm(), 1e-6);
    ASSERT_EQ(reports.size(), static_cast<std::size_t>(summary.iterations) + 1);
    bool rejected = false;
    for (std::size_t i = 1; i < reports.size(); ++i) {
      EXPECT_EQ(reports[i].iteration, static_cast<int>(i));
      EXPECT_LE(reports[i].cost, reports[i - 1].cost);
      rejected = rejected || !reports[i].accepted;
    }
    EXPECT_TRUE(rejected) << "from there a full step overshoots";
  }
}

TEST(Minimizer, GaussNewtonTellsThatItDiverged) {
  Overshooting problem({5.0, -3.0});
  EXPECT_NE(minimize(&problem, with(MinimizerMethod::kGaussNewton)).status,
            MinimizerStatus::kConverged);
}

TEST(Minimizer, StopsAtTheIterationsAllowed) {
  Rosenbrock problem({-1.2, 1.0});
  MinimizerOptions options;
  options.max_iterations = 2;
  const MinimizerSummary summary = minimize(&problem, options);
  EXPECT_EQ(summary.status, MinimizerStatus::kOutOfIterations);
  EXPECT_EQ(summary.iterations, 2);
}

TEST(Minimizer, FailsOnNumbersThatAreNone) {
  Rosenbrock problem({std::numeric_limits<double>::quiet_NaN(), 1.0});
  EXPECT_EQ(minimize(&problem, {}).status, MinimizerStatus::kFailed);
}

TEST(Minimizer, OptionsOutOfRangeAreNamed) {
  MinimizerOptions options;
  options.cost_tolerance = 2.0;
  try {
    options.validate();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cost_tolerance is 2"), std::string::npos);
  }
}

}  // namespace
}  // namespace vins::pose_graph
