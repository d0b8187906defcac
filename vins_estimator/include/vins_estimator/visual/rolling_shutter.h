#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"

namespace vins::estimator {

/// A camera that reads its rows one after the other.
struct RollingShutter {
  double readout = 0.0;  ///< from the first row to the last, which are `height` apart [s]
  int height = 0;        ///< rows of the image
  Eigen::Quaterniond R_bc = Eigen::Quaterniond::Identity();  ///< camera to body

  /// When a row is exposed, after the first [s].
  double rowTime(double row) const { return readout * row / height; }
};

/// The frame as a global shutter would have taken it at its stamp, the first row's time. The turn
/// between that and each feature's row comes from the gyroscope (`gyro`: samples, rising, from the
/// frame's time to the last row's, of which the first stands for the frame; biases taken off), the
/// rest of its motion from its bearing velocity, of which the turn at `mean_rate_b` (mean
/// angular velocity since the image before, free of bias [rad/s]) is no part. Features without a
/// velocity are left out: where they were a few milliseconds before is not known.
FeatureFrame atFirstRow(const FeatureFrame& frame, const RollingShutter& shutter,
                        const std::vector<ImuSample>& gyro, const Eigen::Vector3d& mean_rate_b);

/// Mean angular velocity of the samples [rad/s]; zero without any.
Eigen::Vector3d meanRate(const std::vector<ImuSample>& samples);

}  // namespace vins::estimator
