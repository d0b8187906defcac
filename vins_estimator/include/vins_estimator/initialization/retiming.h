#pragma once

#include <deque>
#include <vector>

#include "vins_core/imu.h"
#include "vins_estimator/inertial/measurement_queue.h"

namespace vins::estimator {

/// Frames with the IMU samples that lead to them by another time offset.
struct RetimedFrames {
  std::vector<SharedMeasurements> frames;  ///< of those given, oldest first
  std::vector<ImuSample> samples;          ///< all that they were cut from
};

/// Cuts the IMU samples of consecutive frames anew for a time offset that is larger by `shift` [s].
/// Leaves out the frames at both ends whose samples are not among those given.
RetimedFrames retime(const std::deque<SharedMeasurements>& frames, double shift);

}  // namespace vins::estimator
