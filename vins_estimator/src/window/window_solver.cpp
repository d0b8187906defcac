#include "vins_estimator/window/window_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <ceres/ceres.h>

#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/window/window_system.h"

namespace vins::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Poses that Ceres moves: of the views, then T_bc where the rig is refined.
std::vector<Pose> posesOf(const WindowValues& values, bool refines_rig) {
  std::vector<Pose> poses;
  for (const NavState& state : values.states) poses.push_back(state.T_wb);
  poses.insert(poses.end(), values.old.begin(), values.old.end());
  if (refines_rig) poses.push_back(values.rig.T_bc);
  return poses;
}

/// The rig's variables but T_bc: what Ceres moves in a block of its own.
RigStep withoutExtrinsic(const RigVariables& variables, const RigCalibration& rig) {
  return selected(variables, minus(rig, RigCalibration())).tail(variables.size() - 6);
}

/// The whole window as one residual of the poses (and the rig, where it is refined), whose square
/// is the cost and whose Jacobian is the square root of their information. Ceres asks for a trial
/// step's cost first, and for Jacobians at the same poses if it takes the step: that is when the
/// system is linearized anew.
class ReducedWindowFactor : public ceres::CostFunction {
 public:
  explicit ReducedWindowFactor(WindowSystem* system)
      : system_(*system), at_(system->present()), trial_(at_), best_(at_) {
    const std::size_t poses = posesOf(at_.values, system->refinesRig()).size();
    mutable_parameter_block_sizes()->assign(poses, 7);
    if (system->refinesRig()) {
      mutable_parameter_block_sizes()->push_back(system->rigVariables().size() - 6);
    }
    poses_columns_ = static_cast<Index>(6 * poses);
    set_num_residuals(static_cast<int>(system->stepCount()) + 1);
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
    const std::vector<Pose> poses = posesOf(at_.values, system_.refinesRig());
    VectorXd steps(system_.stepCount());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const PoseBlock from = toPoseBlock(poses[i]);
      manifold_.Minus(parameters[i], from.data(), steps.data() + 6 * i);
    }
    if (!system_.refinesRig()) return steps;
    const RigStep at = withoutExtrinsic(system_.rigVariables(), at_.values.rig);
    steps.tail(at.size()) = Eigen::Map<const VectorXd>(parameters[poses.size()], at.size()) - at;
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
    writeJacobians(system_.sqrtInformation(), jacobians);
    return true;
  }

  void writeJacobians(const MatrixXd& R, double** jacobians) const {
    const std::vector<int>& sizes = parameter_block_sizes();
    Index column = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      // Of the tangent space: poses stand first.
      const Index count = column < poses_columns_ ? 6 : sizes[i];
      if (jacobians[i] != nullptr) {
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        // A matrix of one column has one order only, which Eigen wants to be told.
        Eigen::Map<RowMajor, 0, Eigen::OuterStride<>> J(jacobians[i], num_residuals(), sizes[i],
                                                        Eigen::OuterStride<>(sizes[i]));
        J.setZero();
        J.topLeftCorner(R.rows(), count) = R.middleCols(column, count);
      }
      column += count;
    }
  }

  WindowSystem& system_;
  PoseManifold manifold_;
  Index poses_columns_ = 0;
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
    const ImuIntrinsics& intrinsics = window->rig.imu;
    if (imu.needsReintegration(from.accelerometer_bias, from.gyroscope_bias, intrinsics)) {
      imu.reintegrate(from.accelerometer_bias, from.gyroscope_bias, intrinsics);
    }
  }
}

ceres::Solver::Summary minimize(const WindowSolverOptions& options, const SlidingWindow& window,
                                ReducedWindowFactor* factor) {
  const WindowValues& start = factor->solution().values;
  std::vector<PoseBlock> poses;
  for (const Pose& pose : posesOf(start, window.refines_rig)) poses.push_back(toPoseBlock(pose));
  RigStep rig = withoutExtrinsic(window.rig_variables, start.rig);
  PoseManifold manifold;
  ceres::Problem problem(problemOptions());
  std::vector<double*> blocks;
  for (PoseBlock& pose : poses) {
    problem.AddParameterBlock(pose.data(), 7, &manifold);
    blocks.push_back(pose.data());
  }
  if (window.refines_rig) {
    problem.AddParameterBlock(rig.data(), static_cast<int>(rig.size()));
    blocks.push_back(rig.data());
  }
  problem.AddResidualBlock(factor, nullptr, blocks);
  ceres::Solver::Summary summary;
  ceres::Solve(solverOptions(options), &problem, &summary);
  return summary;
}

/// The loop's relative pose; nothing when its query has gone.
std::optional<LoopEstimate> loopEstimate(const SlidingWindow& window, const WindowSystem& system) {
  for (std::size_t i = 0; i < window.frames.size(); ++i) {
    if (window.frames[i].keyframe_id != window.loop->query_id) continue;
    LoopEstimate loop;
    loop.T_old_query = window.loop->T_wb.inverse() * window.atImage(window.frames[i]).T_wb;
    loop.covariance = system.relativeCovariance(window.frames.size(), i);
    return loop;
  }
  return std::nullopt;
}

}  // namespace

SolveSummary solveWindow(const WindowSolverOptions& options, SlidingWindow* window) {
  refreshIntegrations(window);
  WindowSystem system(*window, options.huber);
  ReducedWindowFactor factor(&system);
  const ceres::Solver::Summary ceres_summary = minimize(options, *window, &factor);
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
  summary.rig_covariance = system.rigCovariance();
  if (window->loop) summary.loop = loopEstimate(*window, system);
  return summary;
}

}  // namespace vins::estimator
