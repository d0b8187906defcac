#include "vins_estimator/factors/imu_factor.h"

#include <Eigen/LU>

#include "vins_core/so3.h"
#include "vins_estimator/factors/parameter_blocks.h"

namespace vins::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Quantities that residual and Jacobians share.
struct Relative {
  Vector3d position;  ///< in the body at i: what alpha should be
  Vector3d velocity;  ///< what beta should be
  Vector3d rotation;  ///< gamma^-1 R_ij as a rotation vector
  Preintegration::Increments increments;
};

Relative relative(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                  const NavState& j, const ImuIntrinsics& intrinsics) {
  const double t = imu.duration();
  const Eigen::Quaterniond R_bw = i.T_wb.rotation.conjugate();
  Relative r;
  r.increments = imu.corrected(i.accelerometer_bias, i.gyroscope_bias, intrinsics);
  r.position = R_bw * (j.T_wb.position - i.T_wb.position - t * i.v_w - 0.5 * t * t * g_w);
  r.velocity = R_bw * (j.v_w - i.v_w - t * g_w);
  r.rotation = so3::log(r.increments.gamma.conjugate() * R_bw * j.T_wb.rotation);
  return r;
}

template <int n>
void writeJacobian(const Matrix15d& weight, const Eigen::Matrix<double, 15, n>& J,
                   double* jacobian) {
  constexpr int kColumns = n == 6 ? 7 : n;
  Eigen::Map<Eigen::Matrix<double, 15, kColumns, Eigen::RowMajor>> out(jacobian);
  if (kColumns != n) out.template rightCols<1>().setZero();
  out.template leftCols<n>().noalias() = weight * J;
}

}  // namespace

Vector15d imuResidual(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                      const NavState& j) {
  return imuResidual(imu, g_w, i, j, imu.intrinsics());
}

Vector15d imuResidual(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                      const NavState& j, const ImuIntrinsics& intrinsics) {
  const Relative r = relative(imu, g_w, i, j, intrinsics);
  Vector15d residual;
  residual << r.position - r.increments.alpha, r.rotation, r.velocity - r.increments.beta,
      j.accelerometer_bias - i.accelerometer_bias, j.gyroscope_bias - i.gyroscope_bias;
  return residual;
}

ImuJacobians imuJacobians(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                          const NavState& j) {
  return imuJacobians(imu, g_w, i, j, imu.intrinsics());
}

ImuJacobians imuJacobians(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                          const NavState& j, const ImuIntrinsics& intrinsics) {
  const Relative r = relative(imu, g_w, i, j, intrinsics);
  const Matrix3d R_bw = i.T_wb.rotation.conjugate().toRotationMatrix();
  const Matrix3d R_ij = R_bw * j.T_wb.rotation.toRotationMatrix();
  const Matrix3d J_log = so3::rightJacobianInverse(r.rotation);
  const Matrix15d& J = imu.jacobian();
  constexpr int kMotion = kVelocity;  // motion columns start at the velocity

  ImuJacobians out;
  out.J_pose_i.setZero();
  out.J_pose_i.block<3, 3>(kPosition, kPosition) = -R_bw;
  out.J_pose_i.block<3, 3>(kPosition, kRotation) = so3::hat(r.position);
  out.J_pose_i.block<3, 3>(kRotation, kRotation) = -J_log * R_ij.transpose();
  out.J_pose_i.block<3, 3>(kVelocity, kRotation) = so3::hat(r.velocity);

  out.J_pose_j.setZero();
  out.J_pose_j.block<3, 3>(kPosition, kPosition) = R_bw;
  out.J_pose_j.block<3, 3>(kRotation, kRotation) = J_log;

  const Matrix3d J_gamma_bg = J.block<3, 3>(kRotation, kGyrBias);
  const auto& J_intrinsics = imu.intrinsicsJacobian();
  const Vector3d turned = J_gamma_bg * (i.gyroscope_bias - imu.gyroscopeBias()) +
                          J_intrinsics.middleRows<3>(kRotation) * (intrinsics - imu.intrinsics());
  const Matrix3d J_turned = -so3::leftJacobianInverse(r.rotation) * so3::rightJacobian(turned);
  out.J_motion_i.setZero();
  out.J_motion_i.block<3, 3>(kPosition, 0) = -imu.duration() * R_bw;
  out.J_motion_i.block<3, 6>(kPosition, 3) = -J.block<3, 6>(kPosition, kAccBias);
  out.J_motion_i.block<3, 3>(kRotation, kGyrBias - kMotion) = J_turned * J_gamma_bg;
  out.J_motion_i.block<3, 3>(kVelocity, 0) = -R_bw;
  out.J_motion_i.block<3, 6>(kVelocity, 3) = -J.block<3, 6>(kVelocity, kAccBias);
  out.J_motion_i.block<6, 6>(kAccBias, 3) = -Eigen::Matrix<double, 6, 6>::Identity();

  out.J_intrinsics.setZero();
  out.J_intrinsics.topRows<9>() = -J_intrinsics;
  out.J_intrinsics.middleRows<3>(kRotation) = J_turned * J_intrinsics.middleRows<3>(kRotation);

  out.J_motion_j.setZero();
  out.J_motion_j.block<3, 3>(kVelocity, 0) = R_bw;
  out.J_motion_j.block<6, 6>(kAccBias, 3).setIdentity();
  return out;
}

WeightedImuRows weightedImuRows(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                                const NavState& j, const NavState& linearized_i,
                                const NavState& linearized_j, const ImuIntrinsics& intrinsics) {
  const ImuJacobians J = imuJacobians(imu, g_w, linearized_i, linearized_j, intrinsics);
  const Matrix15d& weight = imu.sqrtInformation();
  WeightedImuRows rows;
  rows.J << J.J_motion_i, J.J_motion_j, J.J_pose_i, J.J_pose_j;
  rows.J = (weight * rows.J).eval();
  rows.J_intrinsics = weight * J.J_intrinsics;
  rows.r = weight * imuResidual(imu, g_w, i, j, intrinsics);
  return rows;
}

Matrix15d carriedCovariance(const Preintegration& imu, const Vector3d& g_w, const NavState& i,
                            const Matrix15d& covariance) {
  const ImuJacobians J = imuJacobians(imu, g_w, i, imu.predict(i, g_w));
  Matrix15d J_i, J_j;
  J_i << J.J_pose_i, J.J_motion_i;
  J_j << J.J_pose_j, J.J_motion_j;
  const Matrix15d residuals = J_i * covariance * J_i.transpose() + imu.covariance();
  const Matrix15d J_j_inverse = J_j.inverse();
  return J_j_inverse * residuals * J_j_inverse.transpose();
}

bool ImuFactor::Evaluate(double const* const* parameters, double* residuals,
                         double** jacobians) const {
  if (!imu_.isWeightable()) return false;
  const NavState i = toNavState(parameters[0], parameters[1]);
  const NavState j = toNavState(parameters[2], parameters[3]);
  const Matrix15d& weight = imu_.sqrtInformation();
  Eigen::Map<Vector15d>(residuals).noalias() = weight * imuResidual(imu_, g_w_, i, j, intrinsics_);
  if (jacobians == nullptr) return true;
  const ImuJacobians J =
      imuJacobians(imu_, g_w_, i_.linearizationPoint(i), j_.linearizationPoint(j), intrinsics_);
  if (jacobians[0] != nullptr) writeJacobian<6>(weight, J.J_pose_i, jacobians[0]);
  if (jacobians[1] != nullptr) writeJacobian<9>(weight, J.J_motion_i, jacobians[1]);
  if (jacobians[2] != nullptr) writeJacobian<6>(weight, J.J_pose_j, jacobians[2]);
  if (jacobians[3] != nullptr) writeJacobian<9>(weight, J.J_motion_j, jacobians[3]);
  return true;
}

}  // namespace vins::estimator
