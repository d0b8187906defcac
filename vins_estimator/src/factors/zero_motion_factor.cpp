#include "vins_estimator/factors/zero_motion_factor.h"

#include "vins_core/so3.h"

namespace vins::estimator {

Eigen::Matrix<double, 6, 1> zeroMotionResidual(const ZeroMotionNoise& noise, const Pose& T_wi,
                                               const Pose& T_wj, Eigen::Matrix<double, 6, 6>* J_i,
                                               Eigen::Matrix<double, 6, 6>* J_j) {
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  const Matrix3d R_iw = T_wi.rotation.conjugate().toRotationMatrix();
  const Vector3d position = R_iw * (T_wj.position - T_wi.position);
  const Eigen::Quaterniond R_ij = T_wi.rotation.conjugate() * T_wj.rotation;
  const Vector3d rotation = so3::log(R_ij);
  const double per_metre = 1.0 / noise.position;
  const double per_radian = 1.0 / noise.rotation;
  const Matrix3d J_log = so3::rightJacobianInverse(rotation);
  if (J_i != nullptr) {
    J_i->setZero();
    J_i->topLeftCorner<3, 3>() = -per_metre * R_iw;
    J_i->topRightCorner<3, 3>() = per_metre * so3::hat(position);
    J_i->bottomRightCorner<3, 3>() = -per_radian * J_log * R_ij.toRotationMatrix().transpose();
  }
  if (J_j != nullptr) {
    J_j->setZero();
    J_j->topLeftCorner<3, 3>() = per_metre * R_iw;
    J_j->bottomRightCorner<3, 3>() = per_radian * J_log;
  }
  Eigen::Matrix<double, 6, 1> residual;
  residual << per_metre * position, per_radian * rotation;
  return residual;
}

}  // namespace vins::estimator
