#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vins {

/// Angle to (-pi, pi] [rad].
double wrapAngle(double angle);

/// Turn by `yaw` [rad] about z, the vertical.
Eigen::Quaterniond yawRotation(double yaw);

/// Twist of a rotation about z, within (-pi, pi] [rad]: the yaw of R = yawRotation(yaw) R_swing,
/// where R_swing has no part about z (swing-twist decomposition). That of yawRotation(a) R is a
/// plus that of R. Unlike Euler's yaw it has no trouble with a body whose x axis points up;
/// undefined (0) only for half turns about horizontal axes.
double yawOf(const Eigen::Quaterniond& R);

}  // namespace vins
