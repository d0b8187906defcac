#include "vins_estimator/factors/bearing_factor.h"

#include <cmath>

#include "vins_core/so3.h"
#include "vins_estimator/factors/parameter_blocks.h"

namespace vins {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix23d = Eigen::Matrix<double, 2, 3>;
using Matrix26d = Eigen::Matrix<double, 2, 6>;

/// Tangent-plane residual of a direction `h` (of any length), weighted, and its derivative by h.
Eigen::Vector2d directionResidual(const BearingMeasurement& measured, const Vector3d& h,
                                  Matrix23d* J_h) {
  const double inverse_length = 1.0 / std::sqrt(h.squaredNorm() + 1e-30);
  const Vector3d unit = inverse_length * h;
  const Eigen::Vector2d tangent = measured.basis.transpose() * unit;
  if (J_h != nullptr) {
    J_h->noalias() = (measured.inverse_sigma * inverse_length) *
                     (measured.basis.transpose() - tangent * unit.transpose());
  }
  return measured.inverse_sigma * tangent;
}

/// A landmark's way from the host's camera to the target's, scaled by rho all the way, so that
/// landmarks at infinity take it too.
struct Transfer {
  Matrix3d R_wh;
  Matrix3d R_tw;
  Matrix3d R_cb;
  Vector3d in_host;    ///< rho times its place in the host's body
  Vector3d in_target;  ///< and in the target's
  Vector3d in_camera;  ///< and in the target's camera
};

Transfer transfer(const LandmarkAnchor& anchor, const Pose& T_bc, const Pose& T_wh,
                  const Pose& T_wt, const LandmarkParameters& landmark) {
  const double rho = landmark.z();
  Transfer t;
  t.R_wh = T_wh.rotation.toRotationMatrix();
  t.R_tw = T_wt.rotation.conjugate().toRotationMatrix();
  t.R_cb = T_bc.rotation.conjugate().toRotationMatrix();
  t.in_host = t.R_cb.transpose() * anchoredDirection(anchor, landmark) + rho * T_bc.position;
  t.in_target = t.R_tw * (t.R_wh * t.in_host + rho * (T_wh.position - T_wt.position));
  t.in_camera = t.R_cb * (t.in_target - rho * T_bc.position);
  return t;
}

BearingJacobians bearingJacobians(const Matrix23d& J_h, const Transfer& t,
                                  const LandmarkAnchor& anchor, const Pose& T_bc, const Pose& T_wh,
                                  const Pose& T_wt, const LandmarkParameters& landmark) {
  const double rho = landmark.z();
  const Matrix23d J_body = J_h * t.R_cb;      // by the place in the target's body
  const Matrix23d J_world = J_body * t.R_tw;  // by the place in the world
  const Matrix23d J_host_body = J_world * t.R_wh;
  const Matrix23d J_direction = J_host_body * t.R_cb.transpose();
  BearingJacobians J;
  J.J_host.leftCols<3>() = rho * J_world;
  J.J_host.rightCols<3>() = -J_host_body * so3::hat(t.in_host);
  J.J_target.leftCols<3>() = -rho * J_world;
  J.J_target.rightCols<3>() = J_body * so3::hat(t.in_target);
  J.J_landmark.leftCols<2>() = J_direction * anchor.basis;
  J.J_landmark.col(2) = J_host_body * T_bc.position + J_world * (T_wh.position - T_wt.position) -
                        J_body * T_bc.position;
  J.J_extrinsic.leftCols<3>() = rho * (J_host_body - J_body);
  J.J_extrinsic.rightCols<3>() =
      J_h * so3::hat(t.in_camera) - J_direction * so3::hat(anchoredDirection(anchor, landmark));
  return J;
}

void writePoseJacobian(const Matrix26d& J, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> out(jacobian);
  out.leftCols<6>() = J;
  out.col(6).setZero();
}

}  // namespace

Eigen::Matrix<double, 3, 2> tangentBasis(const Vector3d& bearing) {
  // The axis that is most nearly orthogonal to the bearing.
  int axis = 0;
  bearing.cwiseAbs().minCoeff(&axis);
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = bearing.cross(Vector3d::Unit(axis)).normalized();
  basis.col(1) = bearing.cross(basis.col(0));
  return basis;
}

Vector3d anchoredDirection(const LandmarkAnchor& anchor, const LandmarkParameters& landmark) {
  return anchor.bearing + anchor.basis * landmark.head<2>();
}

Eigen::Vector2d bearingResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const Pose& T_bc, const Pose& T_wb_host, const Pose& T_wb_target,
                                const LandmarkParameters& landmark, BearingJacobians* jacobians) {
  const Transfer t = transfer(anchor, T_bc, T_wb_host, T_wb_target, landmark);
  if (jacobians == nullptr) return directionResidual(measured, t.in_camera, nullptr);
  Matrix23d J_h;
  const Eigen::Vector2d residual = directionResidual(measured, t.in_camera, &J_h);
  *jacobians = bearingJacobians(J_h, t, anchor, T_bc, T_wb_host, T_wb_target, landmark);
  return residual;
}

Eigen::Vector2d firstEstimatesResidual(const BearingMeasurement& measured,
                                       const LandmarkAnchor& anchor, const Pose& T_bc,
                                       const WindowState& host, const Pose& T_wb_host,
                                       const WindowState& target, const Pose& T_wb_target,
                                       const LandmarkParameters& landmark,
                                       BearingJacobians* jacobians) {
  const bool at_present = !host.hasPoseForJacobians() && !target.hasPoseForJacobians();
  const Eigen::Vector2d residual = bearingResidual(measured, anchor, T_bc, T_wb_host, T_wb_target,
                                                   landmark, at_present ? jacobians : nullptr);
  if (!at_present && jacobians != nullptr) {
    bearingResidual(measured, anchor, T_bc, host.poseForJacobians(T_wb_host),
                    target.poseForJacobians(T_wb_target), landmark, jacobians);
  }
  return residual;
}

Eigen::Vector2d hostResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                             const LandmarkParameters& landmark, Matrix23d* J_landmark) {
  Matrix23d J_h;
  const Eigen::Vector2d residual =
      directionResidual(measured, anchoredDirection(anchor, landmark), &J_h);
  if (J_landmark != nullptr) {
    J_landmark->leftCols<2>() = J_h * anchor.basis;
    J_landmark->col(2).setZero();
  }
  return residual;
}

bool BearingFactor::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  BearingJacobians J;
  Eigen::Map<Eigen::Vector2d>{residuals} = firstEstimatesResidual(
      measured_, anchor_, T_bc_, host_, toPose(parameters[0]), target_, toPose(parameters[1]),
      LandmarkParameters(parameters[2]), jacobians != nullptr ? &J : nullptr);
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) writePoseJacobian(J.J_host, jacobians[0]);
  if (jacobians[1] != nullptr) writePoseJacobian(J.J_target, jacobians[1]);
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[2]} = J.J_landmark;
  }
  return true;
}

bool HostBearingFactor::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  Matrix23d J;
  Eigen::Map<Eigen::Vector2d>{residuals} =
      hostResidual(measured_, anchor_, LandmarkParameters(parameters[0]), &J);
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[0]} = J;
  }
  return true;
}

}  // namespace vins
