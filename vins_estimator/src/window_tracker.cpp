#include "window_tracker.h"

#include <cmath>
#include <utility>

#include "vins_core/wall_clock.h"
#include "vins_estimator/health/rest_check.h"
#include "vins_estimator/visual/keyframe_choice.h"
#include "vins_estimator/window/loop_closing.h"
#include "vins_estimator/window/marginalization.h"
#include "vins_estimator/window/motion_only.h"
#include "vins_estimator/window/outlier_gate.h"
#include "vins_estimator/window/window_start.h"

namespace vins::estimator {
namespace {

constexpr int kMinMatches = 15;  // of a loop that is worth its place in the window

/// What is known of the rig before anything is seen.
RigMatrix rigCovariance(const EstimatorOptions& options) {
  constexpr double kExact = 1e-9;
  RigVector sigma = RigVector::Constant(kExact);
  if (options.extrinsic != ExtrinsicMode::kTrusted) {
    sigma.head<3>().setConstant(options.extrinsic_translation_sigma);
    sigma.segment<3>(3).setConstant(options.extrinsic_rotation_sigma);
  }
  if (options.estimate_td) sigma(kTimeOffset) = options.td_sigma;
  if (options.estimate_readout) sigma(kReadout) = options.readout_sigma;
  if (options.estimate_intrinsics) {
    sigma.segment<2>(kIntrinsics).setConstant(options.focal_length_sigma);
    sigma.segment<2>(kIntrinsics + 2).setConstant(options.principal_point_sigma);
    sigma.segment<2>(kIntrinsics + 4).setConstant(options.distortion_sigma);
  }
  if (options.estimate_imu_intrinsics) {
    sigma.tail<kRigSize - kImuIntrinsics>().setConstant(options.imu_intrinsics_sigma);
  }
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace

WindowTracker::WindowTracker(const EstimatorOptions& options) : options_(options) {
  forgetRig();
  clear();
}

void WindowTracker::clear() {
  SlidingWindow fresh;
  fresh.landmarks = Landmarks(options_.pixel_noise, options_.image_height);
  fresh.g_w = Eigen::Vector3d(0.0, 0.0, -options_.imu.gravity);
  fresh.rig = window_.rig;
  fresh.rig_covariance = window_.rig_covariance;
  fresh.refines_rig = window_.refines_rig;
  fresh.rig_variables = window_.rig_variables;
  window_ = std::move(fresh);
  loop_is_new_ = false;
}

void WindowTracker::forgetRig() {
  window_.rig = RigCalibration();
  window_.rig.T_bc = options_.T_bc;
  window_.rig.td = options_.td;
  window_.rig.readout = options_.rolling_shutter_readout;
  window_.rig_variables.camera = options_.estimate_readout || options_.estimate_intrinsics;
  window_.rig_variables.imu = options_.estimate_imu_intrinsics;
  window_.refines_rig = options_.extrinsic != ExtrinsicMode::kTrusted || options_.estimate_td ||
                        window_.rig_variables.camera || window_.rig_variables.imu;
  window_.rig_covariance = rigCovariance(options_);
}

void WindowTracker::setRig(const TurnCalibration& found) {
  // Turns that overlap and features that they share make them agree better than they are right.
  constexpr double kDoubt = 3.0;
  constexpr double kUnknownTranslation = 0.2;  // [m], of a camera whose place nobody has measured
  auto variance = window_.rig_covariance.diagonal();
  if (options_.extrinsic != ExtrinsicMode::kTrusted) {
    window_.rig.T_bc.rotation = found.R_bc;
    variance.segment<3>(3).setConstant(std::pow(kDoubt * found.rotation_sigma, 2));
  }
  if (options_.extrinsic == ExtrinsicMode::kUnknown) {
    window_.rig.T_bc.position.setZero();
    variance.head<3>().setConstant(std::pow(kUnknownTranslation, 2));
  }
  if (options_.estimate_td) {
    setTimeOffset(found.td, kDoubt * found.td_sigma);
  }
}

void WindowTracker::setTimeOffset(double td, double sigma) {
  window_.rig.td = td;
  // What turns have told is the time of the middle row: with another read-out the first row's is
  // another.
  constexpr double kMiddleRow = 0.5;
  RigMatrix& covariance = window_.rig_covariance;
  covariance.row(kTimeOffset) = -kMiddleRow * covariance.row(kReadout);
  covariance.col(kTimeOffset) = covariance.row(kTimeOffset).transpose();
  covariance(kTimeOffset, kTimeOffset) =
      sigma * sigma + kMiddleRow * kMiddleRow * covariance(kReadout, kReadout);
}

void WindowTracker::start(const Initialization& initialization) {
  startWindow(initialization, next_frame_id_, &window_);
  next_frame_id_ += static_cast<FrameId>(initialization.frames.size());
  if (options_.first_estimates) return;
  for (WindowFrame& frame : window_.frames) frame.state.ignoreFirstEstimates();
}

void WindowTracker::addLoop(const LoopMatch& match) {
  // Features that are found again by their looks are placed about twice as badly as tracked ones.
  constexpr double kMatchNoise = 2.0;
  if (vins::estimator::addLoop(match, kMatchNoise, &window_)) loop_is_new_ = true;
}

NavState WindowTracker::append(const FrameMeasurements& measurements, bool stands_still) {
  const WindowFrame& before = window_.frames.back();
  const NavState& last = before.state.value();
  const FrameId id = next_frame_id_++;
  window_.landmarks.addFrame(id, measurements.frame);
  // A rest ends when the images say so: half a second's figures tremble at their bounds.
  const bool has_rested =
      stands_still || (before.has_rested && looksTheSame(window_.landmarks, before.id, id));
  Preintegration imu(options_.imu, last.accelerometer_bias, last.gyroscope_bias, window_.rig.imu);
  imu.integrate(measurements.imu, has_rested);
  const NavState predicted = imu.predict(last, window_.g_w);
  WindowFrame frame{id, measurements.frame.stamp, WindowState(predicted), std::move(imu)};
  frame.stands_still = stands_still;
  frame.has_rested = has_rested;
  frame.td = window_.rig.td;
  frame.readout = measurements.undone_readout;
  frame.interval = toSeconds(frame.stamp - before.stamp);
  if (!measurements.imu.empty()) {
    frame.measured_rate = measurements.imu.back().angular_velocity;
    frame.angular_acceleration = angularAcceleration(measurements.imu);
  }
  if (!options_.first_estimates) frame.state.ignoreFirstEstimates();
  window_.frames.push_back(std::move(frame));
  return predicted;
}

SolveSummary WindowTracker::solve(bool motion_only) {
  WindowSolverOptions solver;
  solver.max_num_iterations = options_.max_num_iterations;
  solver.max_solver_time = options_.max_solver_time;
  const std::size_t frames = window_.frames.size();
  motion_only_ = motion_only && frames > 2 && !isKeyframeAt(frames - 2);
  if (motion_only_) return solveNewestFrames(solver, &window_);
  const SolveSummary summary = solveWindow(solver, &window_);
  if (summary.usable || !window_.loop) return summary;
  // Odometry is worth more than a loop.
  window_.loop.reset();
  return solveWindow(solver, &window_);
}

bool WindowTracker::adjust(bool motion_only, EstimatorResult* result) {
  triangulateTracks(&window_);
  WallClock watch;
  forgetFadedLoop(kMinMatches, &window_);
  const SolveSummary summary = solve(motion_only);
  result->statistics.outliers = removeOutliers({}, &window_);
  result->statistics.solve_seconds = watch.lap();
  reportSolution(summary, result);
  if (!summary.usable) return false;
  window_.frames.back().covariance = summary.newest_covariance;
  if (window_.refines_rig) window_.rig_covariance = summary.rig_covariance;
  reportLoop(summary, result);
  return true;
}

void WindowTracker::reportSolution(const SolveSummary& summary, EstimatorResult* result) {
  EstimatorStatistics& statistics = result->statistics;
  statistics.landmarks = summary.landmarks;
  statistics.observations = summary.observations;
  statistics.iterations = summary.iterations;
  statistics.cost_initial = summary.cost_initial;
  statistics.cost_final = summary.cost_final;
  statistics.motion_only = motion_only_;
  if (!summary.timed_out) return;
  result->events.push_back({result->stamp,
                            Severity::kWarning,
                            "solver_time",
                            "max_solver_time has cut a solution short: the machine is too slow",
                            {{"iterations", static_cast<double>(summary.iterations)}}});
}

/// Hands the loop's refined pose out, once, when it has been solved for the first time.
void WindowTracker::reportLoop(const SolveSummary& summary, EstimatorResult* result) {
  if (!loop_is_new_ || !summary.loop) return;
  loop_is_new_ = false;
  const std::optional<LoopEdge> edge = loopEdge(window_, *summary.loop, kMinMatches);
  if (edge) {
    result->loop_edges.push_back(*edge);
  } else {
    window_.loop.reset();
  }
}

void WindowTracker::slide(std::uint32_t sequence, EstimatorResult* result) {
  const std::size_t second = window_.frames.size() - 2;
  const bool keep = second == 0 || (!motion_only_ && isKeyframeAt(second));
  result->statistics.keyframe = keep;
  if (!keep) {
    dropFrame(&window_, second);
    WindowFrame& newest = window_.frames.back();
    newest.has_rested = newest.has_rested &&
                        looksTheSame(window_.landmarks, window_.frames[second - 1].id, newest.id);
    return;
  }
  makeKeyframe(second, sequence, result);
  if (window_.frames.size() <= static_cast<std::size_t>(options_.window_size)) return;
  WallClock watch;
  const WindowFrame& leaving = window_.frames.front();
  if (leaving.keyframe_id >= 0) result->left.push_back(poseUpdateOf(window_, leaving, sequence));
  forgetLeavingLoop(&window_);
  marginalizeOldest(WindowSolverOptions{}.huber, &window_);
  result->statistics.marginalize_seconds = watch.lap();
}

bool WindowTracker::isKeyframeAt(std::size_t index) const {
  const WindowFrame& frame = window_.frames[index];
  const WindowFrame& last = window_.frames[index - 1];
  if (isStampDoubtful(frame.interval, window_.frames[index + 1].interval)) return false;
  const Eigen::Quaterniond R_bc = window_.rig.T_bc.rotation;
  const Eigen::Quaterniond R_frame_last = R_bc.conjugate() *
                                          frame.state.value().T_wb.rotation.conjugate() *
                                          last.state.value().T_wb.rotation * R_bc;
  const FrameParallax parallax =
      parallaxBetween(window_.landmarks, last.id, frame.id, R_frame_last);
  KeyframeChoiceOptions choice;
  choice.min_parallax = options_.keyframe_parallax;
  choice.min_tracks = options_.min_tracks;
  int tracks = 0;
  for (const auto& [id, track] : window_.landmarks.tracks()) tracks += track.isSeenIn(frame.id);
  if (frame.has_rested) choice = restingChoice(choice);
  return isKeyframe(choice, parallax, tracks, toSeconds(frame.stamp - last.stamp));
}

void WindowTracker::makeKeyframe(std::size_t index, std::uint32_t sequence,
                                 EstimatorResult* result) {
  // A window that begins anew within a sequence has frames of a time that keyframes cover already.
  const Stamp stamp = window_.frames[index].stamp;
  if (last_keyframe_ && last_keyframe_->sequence == sequence && stamp <= last_keyframe_->stamp) {
    return;
  }
  last_keyframe_ = {stamp, sequence};
  window_.frames[index].keyframe_id = next_keyframe_id_++;
  result->keyframes.push_back(keyframeOf(window_, index, sequence));
}

void WindowTracker::keepFirstFrames(std::uint32_t sequence, EstimatorResult* result) {
  for (std::size_t i = 0; i + 1 < window_.frames.size(); ++i) makeKeyframe(i, sequence, result);
}

}  // namespace vins::estimator
