#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vins {

/// Rigid transform T_ab: takes coordinates of frame b to frame a, p_a = R_ab p_b + p_ab.
/// As a pose: where frame b stands in frame a.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< R_ab, unit Hamilton quaternion
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< p_ab [m]

  Pose() = default;
  Pose(const Eigen::Quaterniond& R_ab, const Eigen::Vector3d& p_ab)
      : rotation(R_ab), position(p_ab) {}

  /// T_ac = T_ab T_bc. The rotation is normalized, so that long products stay rotations.
  Pose operator*(const Pose& T_bc) const;

  /// p_a of a point p_b.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_b) const { return rotation * p_b + position; }

  /// T_ba.
  Pose inverse() const;

  /// 4x4 homogeneous matrix.
  Eigen::Matrix4d matrix() const;
};

/// Pose of a 4x4 homogeneous matrix; its upper left block is taken to the nearest rotation.
Pose poseFromMatrix(const Eigen::Matrix4d& T_ab);

/// The group SE(3). Tangent vectors are (rho, phi): translation [m] first, rotation [rad] second.
/// Formulas: Barfoot, "State Estimation for Robotics", 2017, section 7.1 (exponential 7.32,
/// adjoint 7.45, Jacobian 7.83 to 7.95), written for this order of the blocks.
namespace se3 {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Pose of the tangent vector xi.
Pose exp(const Vector6d& xi);

/// Tangent vector of a pose, with a rotation part of length at most pi.
Vector6d log(const Pose& T);

/// Ad with T exp(xi) = exp(Ad xi) T.
Matrix6d adjoint(const Pose& T);

/// J_r with exp(xi + d) = exp(xi) exp(J_r d) to first order in d.
Matrix6d rightJacobian(const Vector6d& xi);

/// Inverse of rightJacobian(); singular only where |phi| is a positive multiple of 2 pi.
Matrix6d rightJacobianInverse(const Vector6d& xi);

}  // namespace se3
}  // namespace vins
