#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "vins_core/loop_match.h"
#include "vins_estimator/estimator.h"
#include "vins_estimator/estimator_options.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/extrinsic_rotation.h"
#include "vins_estimator/initialization/initialization.h"
#include "vins_estimator/window/sliding_window.h"
#include "vins_estimator/window/window_solver.h"

namespace vins::estimator {

/// Follows the body once the first states are known: takes frames into the window, adjusts it, and
/// slides it on.
class WindowTracker {
 public:
  explicit WindowTracker(const EstimatorOptions& options);

  const SlidingWindow& window() const { return window_; }

  /// Forgets frames, landmarks and prior; what was learned of the rig stays.
  void clear();
  /// As at the very first.
  void forgetRig();
  /// What the rig's turns have told of it. Where the camera's pose is unknown, its place still is.
  void setRig(const TurnCalibration& found);

  /// The time offset as the search has found it, with its deviation [s].
  void setTimeOffset(double td, double sigma);

  void start(const Initialization& initialization);

  /// A verified loop, for the next adjustments; without effect where its query has left.
  void addLoop(const LoopMatch& match);

  /// The frame, where the IMU says that it is. Returns that state.
  NavState append(const FrameMeasurements& measurements, bool stands_still);

  /// Adjusts the window, or with `motion_only` only its newest frames unless the second newest is
  /// to become a keyframe. False where there is no solution: the window is as it was.
  bool adjust(bool motion_only, EstimatorResult* result);

  /// Keeps the second newest frame or lets it go, and makes room.
  void slide(std::uint32_t sequence, EstimatorResult* result);

  /// The frames that the window starts with become keyframes.
  void keepFirstFrames(std::uint32_t sequence, EstimatorResult* result);

 private:
  bool isKeyframeAt(std::size_t index) const;
  SolveSummary solve(bool motion_only);
  void makeKeyframe(std::size_t index, std::uint32_t sequence, EstimatorResult* result);
  void reportSolution(const SolveSummary& summary, EstimatorResult* result);
  void reportLoop(const SolveSummary& summary, EstimatorResult* result);

  EstimatorOptions options_;
  SlidingWindow window_;
  FrameId next_frame_id_ = 0;
  std::int64_t next_keyframe_id_ = 0;
  struct LastKeyframe {
    Stamp stamp = 0;
    std::uint32_t sequence = 0;
  };
  std::optional<LastKeyframe> last_keyframe_;  ///< that was handed out
  bool motion_only_ = false;                   ///< of the last adjustment
  bool loop_is_new_ = false;
};

}  // namespace vins::estimator
