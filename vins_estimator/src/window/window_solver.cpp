#include "vins_estimator/window/window_solver.h"

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include <ceres/ceres.h>

#include "vins_estimator/factors/bearing_factor.h"
#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/factors/prior_factor.h"
#include "vins_estimator/factors/zero_velocity_factor.h"

namespace vins {
namespace {

ceres::Problem::Options problemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

struct StateBlocks {
  PoseBlock pose;
  MotionBlock motion;
};

/// The window as Ceres sees it. Lives for one solution.
class WindowProblem {
 public:
  WindowProblem(double huber, SlidingWindow* window)
      : window_(*window),
        huber_(huber),
        still_(window->still_velocity),
        problem_(problemOptions()) {
    addStates();
    addImu();
    addStillness();
    addPrior();
    addLandmarks();
  }

  ceres::Solver::Summary solve(ceres::Solver::Options options) {
    options.linear_solver_ordering = ordering_;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return summary;
  }

  void writeBack() {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      window_.frames[i].state.setValue(
          toNavState(states_[i].pose.data(), states_[i].motion.data()));
    }
    for (std::size_t k = 0; k < landmarks_.size(); ++k) {
      landmarks_[k]->parameters = LandmarkParameters(landmark_blocks_[k].data());
    }
  }

  int landmarkCount() const { return static_cast<int>(landmarks_.size()); }
  int observationCount() const {
    return static_cast<int>(bearing_factors_.size() + host_factors_.size());
  }

 private:
  void addStates() {
    for (const WindowFrame& frame : window_.frames) {
      const NavState& state = frame.state.value();
      states_.push_back({toPoseBlock(state.T_wb), toMotionBlock(state)});
    }
    for (StateBlocks& state : states_) {
      problem_.AddParameterBlock(state.pose.data(), 7, &manifold_);
      problem_.AddParameterBlock(state.motion.data(), 9);
      ordering_->AddElementToGroup(state.pose.data(), 1);
      ordering_->AddElementToGroup(state.motion.data(), 1);
    }
  }

  void addImu() {
    for (std::size_t i = 1; i < states_.size(); ++i) {
      const WindowFrame& to = window_.frames[i];
      imu_factors_.emplace_back(to.imu, window_.g_w, window_.frames[i - 1].state, to.state);
      problem_.AddResidualBlock(&imu_factors_.back(), nullptr, states_[i - 1].pose.data(),
                                states_[i - 1].motion.data(), states_[i].pose.data(),
                                states_[i].motion.data());
    }
  }

  void addStillness() {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (window_.frames[i].stands_still) {
        problem_.AddResidualBlock(&still_, nullptr, states_[i].motion.data());
      }
    }
  }

  void addPrior() {
    if (window_.prior.empty()) return;
    std::vector<double*> blocks;
    for (const Prior::Part& part : window_.prior.parts) {
      StateBlocks& state = states_[part.frame];
      blocks.push_back(part.motion ? state.motion.data() : state.pose.data());
    }
    prior_factor_ = std::make_unique<PriorFactor>(window_.prior);
    problem_.AddResidualBlock(prior_factor_.get(), nullptr, blocks);
  }

  void addLandmarks() {
    std::map<FrameId, std::size_t> index;
    for (std::size_t i = 0; i < window_.frames.size(); ++i) index[window_.frames[i].id] = i;
    for (auto& [id, landmark] : window_.landmarks.tracks()) {
      if (landmark.has_depth) landmarks_.push_back(&landmark);
    }
    landmark_blocks_.resize(landmarks_.size());
    for (std::size_t k = 0; k < landmarks_.size(); ++k) {
      Eigen::Map<Eigen::Vector3d>{landmark_blocks_[k].data()} = landmarks_[k]->parameters;
      addLandmark(index, *landmarks_[k], landmark_blocks_[k].data());
    }
  }

  void addLandmark(const std::map<FrameId, std::size_t>& index, const Landmark& landmark,
                   double* parameters) {
    const TrackObservation& own = landmark.observations.front();
    const std::size_t host = index.at(own.frame);
    host_factors_.emplace_back(own.measured, landmark.anchor);
    problem_.AddResidualBlock(&host_factors_.back(), &huber_, parameters);
    ordering_->AddElementToGroup(parameters, 0);
    for (std::size_t k = 1; k < landmark.observations.size(); ++k) {
      const TrackObservation& observation = landmark.observations[k];
      const std::size_t target = index.at(observation.frame);
      bearing_factors_.emplace_back(observation.measured, landmark.anchor, window_.T_bc,
                                    window_.frames[host].state, window_.frames[target].state);
      problem_.AddResidualBlock(&bearing_factors_.back(), &huber_, states_[host].pose.data(),
                                states_[target].pose.data(), parameters);
    }
  }

  SlidingWindow& window_;
  PoseManifold manifold_;
  ceres::HuberLoss huber_;
  ZeroVelocityFactor still_;
  // Ceres orders blocks by their addresses: one array each keeps the order, and so the result, the
  // same in every run.
  std::vector<StateBlocks> states_;
  std::vector<Landmark*> landmarks_;
  std::vector<std::array<double, 3>> landmark_blocks_;
  std::deque<ImuFactor> imu_factors_;
  std::deque<BearingFactor> bearing_factors_;
  std::deque<HostBearingFactor> host_factors_;
  std::unique_ptr<PriorFactor> prior_factor_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
  ceres::Problem problem_;  // last: it refers to all the others
};

ceres::Solver::Options solverOptions(const WindowSolverOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_SCHUR;
  ceres_options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
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

}  // namespace

SolveSummary solveWindow(const WindowSolverOptions& options, SlidingWindow* window) {
  refreshIntegrations(window);
  WindowProblem problem(options.huber, window);
  const ceres::Solver::Summary ceres_summary = problem.solve(solverOptions(options));
  SolveSummary summary;
  summary.usable = ceres_summary.IsSolutionUsable();
  summary.iterations = static_cast<int>(ceres_summary.iterations.size()) - 1;
  summary.landmarks = problem.landmarkCount();
  summary.observations = problem.observationCount();
  summary.cost_initial = ceres_summary.initial_cost;
  summary.cost_final = ceres_summary.final_cost;
  summary.timed_out = options.max_solver_time > 0.0 &&
                      ceres_summary.termination_type == ceres::NO_CONVERGENCE &&
                      summary.iterations < options.max_num_iterations;
  if (summary.usable) problem.writeBack();
  return summary;
}

}  // namespace vins
