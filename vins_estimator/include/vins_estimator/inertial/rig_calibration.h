#pragma once

#include <Eigen/Core>

#include "vins_core/pose.h"

namespace vins::estimator {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

/// How camera and IMU stand to each other in space and time. Errors are stacked as position [m],
/// rotation [rad, on the right], td [s].
struct RigCalibration {
  Pose T_bc;        ///< camera in the body frame
  double td = 0.0;  ///< t_imu = t_cam + td [s]
};

/// calibration [+] d.
RigCalibration plus(const RigCalibration& calibration, const Vector7d& d);

/// d with plus(from, d) = to.
Vector7d minus(const RigCalibration& to, const RigCalibration& from);

}  // namespace vins::estimator
