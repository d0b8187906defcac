#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rotations: the group SO(3), its tangent space of rotation vectors (axis times angle, radians).
/// Rotations are unit Hamilton quaternions. Perturbations act on the right: R [+] d = R exp(d^).
/// Formulas: J. Sola, J. Deray, D. Atchuthan, "A micro Lie theory for state estimation in
/// robotics", 2018, appendix B; T. D. Barfoot, "State Estimation for Robotics", 2017, chapter 7.
/// Every function is accurate to a few units in the last place for all angles, zero and pi
/// included.
namespace vins::so3 {

/// Skew-symmetric matrix with hat(a) b = a x b.
Eigen::Matrix3d hat(const Eigen::Vector3d& a);

/// Inverse of hat(); the symmetric part of `skew` is ignored.
Eigen::Vector3d vee(const Eigen::Matrix3d& skew);

/// Unit quaternion of the rotation vector `phi` [rad], of any length.
Eigen::Quaterniond exp(const Eigen::Vector3d& phi);

/// Rotation vector of length at most pi. `q` needs not be normalized, and may be q or -q.
Eigen::Vector3d log(const Eigen::Quaterniond& q);

/// J_r with exp(phi + d) = exp(phi) exp(J_r d) to first order in d.
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi);

/// Inverse of rightJacobian(); singular only where |phi| is a positive multiple of 2 pi.
Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi);

/// J_l with exp(phi + d) = exp(J_l d) exp(phi) to first order in d. J_l(phi) = J_r(-phi).
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi);

/// Inverse of leftJacobian().
Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& phi);

}  // namespace vins::so3
