#include "vins_estimator/window/window_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <ceres/ceres.h>

#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/window/window_system.h"

namespace vins {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The whole window as one residual of the poses, whose square is the cost and whose Jacobian is
/// the square root of the poses' information. Ceres asks for a trial step's cost first, and for
/// Jacobians at the same poses if it takes the step: that is when the system is linearized anew.
class ReducedWindowFactor : public ceres::CostFunction {
 public:
  explicit ReducedWindowFactor(WindowSystem* system)
      : system_(*system), at_(system->present()), trial_(at_), best_(at_) {
    const auto frames = static_cast<int>(system->frameCount());
    for (int i = 0; i < frames; ++i) mutable_parameter_block_sizes()->push_back(7);
    set_num_residuals(6 * frames + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    tryAt(stepsTo(parameters));
    const double cost = trial_cost_;
    if (!std::isfinite(cost)) return false;
    Eigen::Map<VectorXd> r(residuals, num_residuals());
    r.setZero();
    r.tail<1>()[0] = std::sqrt(2.0 * cost);
    return jacobians == nullptr || linearize(cost, &r, jacobians);
  }

  /// The point of least cost.
  const WindowSystem::Point& solution() const { return best_; }

 private:
  VectorXd stepsTo(double const* const* parameters) const {
    VectorXd steps(static_cast<Index>(6 * at_.states.size()));
    for (std::size_t i = 0; i < at_.states.size(); ++i) {
      const PoseBlock from = toPoseBlock(at_.states[i].T_wb);
      manifold_.Minus(parameters[i], from.data(), steps.data() + 6 * i);
    }
    return steps;
  }

  /// Ceres asks twice for the same step: for its cost, and for Jacobians when it takes it.
  void tryAt(const VectorXd& steps) const {
    if (tried_ && steps == trial_steps_) return;
    if (linearized_) trial_ = system_.moved(steps);
    trial_steps_ = steps;
    trial_cost_ = system_.cost(trial_);
    tried_ = true;
    if (trial_cost_ >= best_cost_) return;
    best_cost_ = trial_cost_;
    best_ = trial_;
  }

  bool linearize(double cost, Eigen::Map<VectorXd>* r, double** jacobians) const {
    at_ = trial_;
    tried_ = false;
    linearized_ = system_.linearize(at_);
    if (!linearized_) return false;
    const VectorXd y = system_.sqrtGradient();
    r->head(y.size()) = y;
    r->tail<1>()[0] = std::sqrt(std::max(0.0, 2.0 * cost - y.squaredNorm()));
    const MatrixXd R = system_.sqrtInformation();
    for (std::size_t i = 0; i < at_.states.size(); ++i) {
      if (jacobians[i] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> J(jacobians[i],
                                                                              num_residuals(), 7);
      J.setZero();
      J.topLeftCorner(R.rows(), 6) = R.middleCols<6>(static_cast<Index>(6 * i));
    }
    return true;
  }

  WindowSystem& system_;
  PoseManifold manifold_;
  // Where Ceres stands and what it tries: it evaluates through a const interface.
  mutable WindowSystem::Point at_;
  mutable WindowSystem::Point trial_;
  mutable WindowSystem::Point best_;
  mutable double best_cost_ = std::numeric_limits<double>::infinity();
  mutable VectorXd trial_steps_;
  mutable double trial_cost_ = 0.0;
  mutable bool tried_ = false;
  mutable bool linearized_ = false;
};

ceres::Problem::Options problemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

ceres::Solver::Options solverOptions(const WindowSolverOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres_options.max_num_iterations = options.max_num_iterations;
  if (options.max_solver_time > 0.0) {
    ceres_options.max_solver_time_in_seconds = options.max_solver_time;
  }
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.num_threads = 1;
  ceres_options.logging_type = ceres::SILENT;
  return ceres_options;
}

/// Integrations whose bias has moved too far for the first-order correction.
void refreshIntegrations(SlidingWindow* window) {
  for (std::size_t i = 1; i < window->frames.size(); ++i) {
    const NavState& from = window->frames[i - 1].state.value();
    Preintegration& imu = window->frames[i].imu;
    if (imu.needsReintegration(from.accelerometer_bias, from.gyroscope_bias)) {
      imu.reintegrate(from.accelerometer_bias, from.gyroscope_bias);
    }
  }
}

ceres::Solver::Summary minimize(const WindowSolverOptions& options, ReducedWindowFactor* factor) {
  std::vector<PoseBlock> poses;
  for (const NavState& state : factor->solution().states) poses.push_back(toPoseBlock(state.T_wb));
  PoseManifold manifold;
  ceres::Problem problem(problemOptions());
  std::vector<double*> blocks;
  for (PoseBlock& pose : poses) {
    problem.AddParameterBlock(pose.data(), 7, &manifold);
    blocks.push_back(pose.data());
  }
  problem.AddResidualBlock(factor, nullptr, blocks);
  ceres::Solver::Summary summary;
  ceres::Solve(solverOptions(options), &problem, &summary);
  return summary;
}

}  // namespace

SolveSummary solveWindow(const WindowSolverOptions& options, SlidingWindow* window) {
  refreshIntegrations(window);
  WindowSystem system(*window, options.huber);
  ReducedWindowFactor factor(&system);
  const ceres::Solver::Summary ceres_summary = minimize(options, &factor);
  SolveSummary summary;
  summary.usable = ceres_summary.IsSolutionUsable();
  summary.iterations = static_cast<int>(ceres_summary.iterations.size()) - 1;
  summary.landmarks = static_cast<int>(system.landmarkCount());
  summary.observations = static_cast<int>(system.observationCount());
  summary.cost_initial = ceres_summary.initial_cost;
  summary.cost_final = ceres_summary.final_cost;
  summary.timed_out = options.max_solver_time > 0.0 &&
                      ceres_summary.termination_type == ceres::NO_CONVERGENCE &&
                      summary.iterations < options.max_num_iterations;
  if (!summary.usable) return summary;
  system.writeTo(factor.solution(), window);
  summary.newest_covariance = system.newestCovariance();
  return summary;
}

}  // namespace vins
