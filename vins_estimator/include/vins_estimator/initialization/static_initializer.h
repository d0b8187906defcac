#pragma once

#include <optional>
#include <vector>

#include "vins_core/imu.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/initialization.h"

namespace vins::estimator {

/// Options of initializeAtRest().
struct StaticInitializerOptions {
  int frames = 4;                ///< handed over, spread over the still interval; at least 2
  double position_sigma = 1e-3;  ///< the convention's: where the body stands is the origin [m]
  double tilt_sigma = 0.5;       ///< before the accelerometer is asked, which the window does [rad]
  double yaw_sigma = 1e-3;       ///< the same for yaw [rad]
  double velocity_sigma = 1.0;   ///< before the body is said to be at rest [m/s]
  double accelerometer_bias_sigma = 0.2;   ///< before anything is known of it [m/s^2]
  double min_gyroscope_bias_sigma = 5e-4;  ///< besides what the samples' scatter says [rad/s]

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// The rotation body to world that turns `up_b` (unit, the direction of the specific force at rest)
/// to the vertical and has no twist about it (swing-twist decomposition): the convention for yaw
/// zero, which exists for every attitude but upside down, where the choice is arbitrary.
Eigen::Quaterniond levelRotation(const Eigen::Vector3d& up_b);

/// The same attitude with its twist about the vertical taken away.
Eigen::Quaterniond withoutYaw(const Eigen::Quaterniond& R_wb);

/// The first states of a body that has stood still over these frames (oldest first, each with the
/// samples since the one before; the first one's are not used): roll and pitch from the mean
/// specific force, gyroscope bias from the mean rate; accelerometer bias zero, with the deviation
/// that the options say. The deviations leave out what the frames' own measurements tell: that they
/// stand still and feel gravity, which ties tilt and accelerometer bias together. Nothing where
/// there are fewer than two frames or no samples.
std::optional<Initialization> initializeAtRest(
    const std::vector<const FrameMeasurements*>& interval, const ImuNoise& noise,
    const StaticInitializerOptions& options = {});

}  // namespace vins::estimator
