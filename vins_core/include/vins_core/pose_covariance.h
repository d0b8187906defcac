#pragma once

#include "vins_core/pose.h"

namespace vins {

/// Covariances of poses in the two conventions that meet in this system. Rows and columns are
/// position [m], then rotation [rad].
///
/// - *Body axes*, what the estimator works with: the error of T_ab is (dp, dtheta), with
///   p_ab + dp along the axes of a, and R_ab exp(dtheta), about the axes of b.
/// - *Fixed axes*, what ROS's messages mean (geometry_msgs/PoseWithCovariance): (dp, dphi) with
///   exp(dphi) R_ab, both along the axes of a.

/// Takes the covariance of T_ab from body axes to fixed axes: dphi = R_ab dtheta.
se3::Matrix6d aboutFixedAxes(const Eigen::Quaterniond& R_ab, const se3::Matrix6d& covariance);

/// Takes the covariance of T_ab from fixed axes to body axes: the inverse of aboutFixedAxes().
se3::Matrix6d aboutBodyAxes(const Eigen::Quaterniond& R_ab, const se3::Matrix6d& covariance);

/// Covariance of T_ac = T_ab T_bc, from those of its factors, which are independent of each other.
/// All three are about the fixed axes of their first frames.
se3::Matrix6d covarianceOfProduct(const Pose& T_ab, const se3::Matrix6d& covariance_ab,
                                  const Pose& T_bc, const se3::Matrix6d& covariance_bc);

/// Covariance of a transform T_ab of which it is known how well it places one point p_b:
/// `covariance` is that of the point's position in a, and of the rotation. `arm_a` = R_ab p_b [m]
/// is the way from T_ab's origin to the point. Both covariances are about fixed axes.
se3::Matrix6d covarianceByPoint(const Eigen::Vector3d& arm_a, const se3::Matrix6d& covariance);

}  // namespace vins
