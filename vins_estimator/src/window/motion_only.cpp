#include "vins_estimator/window/motion_only.h"

#include <deque>
#include <vector>

#include <ceres/ceres.h>

#include "vins_core/so3.h"
#include "vins_estimator/factors/bearing_factor.h"
#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/window/linearization.h"

namespace vins::estimator {
namespace {

/// The newest keyframe; the frame before the newest where there is none.
std::size_t newestKeyframe(const SlidingWindow& window) {
  std::size_t index = window.frames.size() - 1;
  while (index > 0 && window.frames[index].keyframe_id < 0) --index;
  return window.frames[index].keyframe_id < 0 ? window.frames.size() - 2 : index;
}

/// The window as blocks for Ceres, of which only the frames after `anchor` move.
class NewestFrames {
 public:
  NewestFrames(const SlidingWindow& window, double huber)
      : window_(window),
        geometry_(geometryOf(window, window.values())),
        anchor_(newestKeyframe(window)),
        loss_(huber),
        problem_(options()) {
    for (const WindowFrame& frame : window.frames) {
      poses_.push_back(toPoseBlock(frame.state.value().T_wb));
      motions_.push_back(toMotionBlock(frame.state.value()));
    }
    for (std::size_t i = anchor_ + 1; i < poses_.size(); ++i) addImu(i);
    for (const auto& [id, landmark] : window.landmarks.tracks()) {
      if (landmark.has_depth) addLandmark(landmark);
    }
    for (auto& landmark : landmarks_) problem_.SetParameterBlockConstant(landmark.data());
    for (std::size_t i = 0; i <= anchor_; ++i) {
      if (problem_.HasParameterBlock(poses_[i].data())) {
        problem_.SetParameterBlockConstant(poses_[i].data());
      }
    }
    problem_.SetParameterBlockConstant(motions_[anchor_].data());
  }

  std::size_t anchor() const { return anchor_; }
  std::size_t landmarkCount() const { return landmarks_.size(); }
  int observationCount() const { return observations_; }

  ceres::Solver::Summary solve(const WindowSolverOptions& options) {
    ceres::Solver::Options ceres_options;
    ceres_options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    ceres_options.max_num_iterations = options.max_num_iterations;
    ceres_options.function_tolerance = options.function_tolerance;
    ceres_options.num_threads = 1;
    ceres_options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(ceres_options, &problem_, &summary);
    return summary;
  }

  void writeTo(SlidingWindow* window) const {
    for (std::size_t i = anchor_ + 1; i < poses_.size(); ++i) {
      window->frames[i].state.setValue(toNavState(poses_[i].data(), motions_[i].data()));
    }
  }

 private:
  static ceres::Problem::Options options() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void addPose(std::size_t frame) {
    problem_.AddParameterBlock(poses_[frame].data(), 7, &manifold_);
  }

  void addImu(std::size_t frame) {
    addPose(frame - 1);
    addPose(frame);
    const auto& frames = window_.frames;
    problem_.AddResidualBlock(new ImuFactor(frames[frame].imu, window_.g_w, frames[frame - 1].state,
                                            frames[frame].state, window_.rig.imu),
                              nullptr, poses_[frame - 1].data(), motions_[frame - 1].data(),
                              poses_[frame].data(), motions_[frame].data());
  }

  /// What the frames that move see of a landmark of a frame that does not.
  void addLandmark(const Landmark& landmark) {
    const std::size_t host = window_.indexOf(landmark.host());
    if (host > anchor_) return;
    bool added = false;
    for (const TrackObservation& o : landmark.observations) {
      const std::size_t target = window_.indexOf(o.frame);
      if (target <= anchor_) continue;
      if (!added) landmarks_.push_back(landmark.parameters);
      added = true;
      addPose(host);
      problem_.AddResidualBlock(
          new BearingFactor(o.measured, landmark.anchor, window_.rig.T_bc,
                            window_.frames[host].state, window_.frames[target].state,
                            geometry_.present[host], geometry_.present[target]),
          &loss_, poses_[host].data(), poses_[target].data(), landmarks_.back().data());
      ++observations_;
    }
  }

  const SlidingWindow& window_;
  WindowGeometry geometry_;
  std::size_t anchor_;
  ceres::HuberLoss loss_;
  PoseManifold manifold_;
  // Blocks must stay where they are; those of one kind lie in the order of time (see Ceres' own
  // ordering, which goes by address).
  std::deque<PoseBlock> poses_;
  std::deque<MotionBlock> motions_;
  std::deque<LandmarkParameters> landmarks_;
  int observations_ = 0;
  ceres::Problem problem_;
};

/// The anchor's covariance, carried over the intervals after it.
Matrix15d covarianceFrom(const SlidingWindow& window, std::size_t anchor) {
  Matrix15d covariance = window.frames[anchor].covariance;
  for (std::size_t i = anchor + 1; i < window.frames.size(); ++i) {
    const NavState& from = window.frames[i - 1].state.value();
    covariance = carriedCovariance(window.frames[i].imu, window.g_w, from, covariance);
  }
  return covariance;
}

}  // namespace

SolveSummary solveNewestFrames(const WindowSolverOptions& options, SlidingWindow* window) {
  NewestFrames problem(*window, options.huber);
  const ceres::Solver::Summary ceres_summary = problem.solve(options);
  SolveSummary summary;
  summary.usable = ceres_summary.IsSolutionUsable();
  summary.iterations = static_cast<int>(ceres_summary.iterations.size()) - 1;
  summary.landmarks = static_cast<int>(problem.landmarkCount());
  summary.observations = problem.observationCount();
  summary.cost_initial = ceres_summary.initial_cost;
  summary.cost_final = ceres_summary.final_cost;
  summary.rig_covariance = window->rig_covariance;
  if (!summary.usable) return summary;
  problem.writeTo(window);
  summary.newest_covariance = covarianceFrom(*window, problem.anchor());
  return summary;
}

}  // namespace vins::estimator
