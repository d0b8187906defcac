#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/pose.h"

namespace vins {

/// Angle to (-pi, pi] [rad].
double wrapAngle(double angle);

/// Turn by `yaw` [rad] about z, the vertical.
Eigen::Quaterniond yawRotation(double yaw);

/// Twist of a rotation about z [rad]: the yaw of R = yawRotation(yaw) R_swing, where R_swing has no
/// part about z (swing-twist decomposition). Unlike Euler's yaw it has no trouble with a body
/// whose x axis points up; undefined (0) only for half turns about horizontal axes.
double yawOf(const Eigen::Quaterniond& R);

/// T_mw of a keyframe: the transform with yaw only that takes its pose in the odometry's world to
/// its pose in the map, T_mb = T_mw T_wb, for poses that differ by such a transform.
Pose driftOf(const Pose& T_mb, const Pose& T_wb);

}  // namespace vins
