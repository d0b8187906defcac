#include "vins_estimator/factors/bearing_factor.h"

#include <cmath>

#include "vins_core/so3.h"
#include "vins_estimator/factors/parameter_blocks.h"

namespace vins::estimator {
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

/// Direction in the target's camera of a landmark, times rho: landmarks at infinity have it, too.
Vector3d directionInTarget(const Vector3d& direction_w, const ViewGeometry& host,
                           const ViewGeometry& target, double rho) {
  return target.R_wc.transpose() * (direction_w + rho * (host.p_wc - target.p_wc));
}

/// Mean angular velocity of a camera from its first row's time until `late` seconds later.
Vector3d meanRate(const ViewGeometry& view, double late) {
  return view.w_c + 0.5 * late * view.a_c;
}

/// How fast a direction (times rho) moves in a camera that moves, in the mean until `late`.
Vector3d directionRate(const ViewGeometry& view, double late, const Vector3d& direction,
                       double rho) {
  return meanRate(view, late).cross(direction) + rho * view.v_c;
}

/// The landmark's direction in the host's camera at its first row's time; it was measured later.
Vector3d directionInHost(const LandmarkAnchor& anchor, const ViewGeometry& host,
                         const LandmarkParameters& landmark) {
  const Vector3d direction = anchoredDirection(anchor, landmark);
  if (host.readout == 0.0) return direction;
  const double late = host.readout * anchor.row;
  return direction + late * directionRate(host, late, direction, landmark.z());
}

/// Direction in the target's camera when it saw the landmark.
Vector3d directionWhenSeen(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                           const ViewGeometry& host, const ViewGeometry& target,
                           const LandmarkParameters& landmark) {
  const double rho = landmark.z();
  const Vector3d h =
      directionInTarget(host.R_wc * directionInHost(anchor, host, landmark), host, target, rho);
  const double late = target.readout * measured.row;
  return late == 0.0 ? h : Vector3d(h - late * directionRate(target, late, h, rho));
}

/// Derivative of the residual of a direction by the observing camera's intrinsics.
Matrix26d intrinsicsJacobianAt(const BearingMeasurement& measured, const Vector3d& direction) {
  return -measured.inverse_sigma * measured.basis.transpose() *
         bearingCorrectionJacobian(direction.normalized());
}

/// The residual's part of the observing camera's intrinsics.
Eigen::Vector2d intrinsicsResidual(const BearingMeasurement& measured, const ViewGeometry& view,
                                   const Vector3d& direction) {
  if (view.intrinsics.isZero(0.0)) return Eigen::Vector2d::Zero();
  return intrinsicsJacobianAt(measured, direction) * view.intrinsics;
}

void writePoseJacobian(const Matrix26d& J, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> out(jacobian);
  out.leftCols<6>() = J;
  out.col(6).setZero();
}

}  // namespace

Vector3d anchoredDirection(const LandmarkAnchor& anchor, const LandmarkParameters& landmark) {
  return anchor.bearing + anchor.basis * landmark.head<2>();
}

ViewGeometry viewGeometry(const Pose& T_wb, const Pose& T_bc) {
  ViewGeometry view;
  view.R_wb = T_wb.rotation.toRotationMatrix();
  view.p_wb = T_wb.position;
  view.R_wc = view.R_wb * T_bc.rotation.toRotationMatrix();
  view.p_wc = view.R_wb * T_bc.position + T_wb.position;
  return view;
}

ViewGeometry movedTo(const Pose& T_wb, const Pose& T_bc, const ViewGeometry& view) {
  ViewGeometry moved = viewGeometry(T_wb, T_bc);
  moved.w_c = view.w_c;
  moved.v_c = view.v_c;
  moved.a_c = view.a_c;
  moved.readout = view.readout;
  moved.intrinsics = view.intrinsics;
  return moved;
}

Eigen::Vector2d bearingResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const ViewGeometry& host, const ViewGeometry& target,
                                const LandmarkParameters& landmark, BearingJacobians* jacobians) {
  const double rho = landmark.z();
  const Vector3d direction_w = host.R_wc * directionInHost(anchor, host, landmark);
  Vector3d h = directionInTarget(direction_w, host, target, rho);
  const double late = target.readout * measured.row;
  if (late != 0.0) h -= late * directionRate(target, late, h, rho);
  const Eigen::Vector2d correction = intrinsicsResidual(measured, target, h);
  if (jacobians == nullptr) return directionResidual(measured, h, nullptr) + correction;
  Matrix23d J_h;
  const Eigen::Vector2d residual = directionResidual(measured, h, &J_h) + correction;
  // By the direction in the target's camera at its first row's time.
  const Matrix23d J_first =
      late == 0.0 ? J_h : Matrix23d(J_h - late * J_h * so3::hat(meanRate(target, late)));
  const Matrix23d J_w = J_first * target.R_wc.transpose();  // by the landmark's place in the world
  // A body's turn moves the landmark by the lever from the body to it, and the other way round.
  const Vector3d from_host = direction_w + rho * (host.p_wc - host.p_wb);
  const Vector3d from_target = direction_w + rho * (host.p_wc - target.p_wb);
  jacobians->J_host.leftCols<3>() = rho * J_w;
  jacobians->J_host.rightCols<3>().noalias() = -(J_w * so3::hat(from_host)) * host.R_wb;
  jacobians->J_target.leftCols<3>() = -rho * J_w;
  jacobians->J_target.rightCols<3>().noalias() = (J_w * so3::hat(from_target)) * target.R_wb;
  const Matrix23d J_host_direction = J_w * host.R_wc;
  jacobians->J_landmark.leftCols<2>().noalias() = J_host_direction * anchor.basis;
  jacobians->J_landmark.col(2).noalias() = J_w * (host.p_wc - target.p_wc);
  if (late != 0.0) jacobians->J_landmark.col(2) -= late * J_h * target.v_c;
  const double host_late = host.readout * anchor.row;
  if (host_late != 0.0) {
    jacobians->J_landmark.leftCols<2>() +=
        host_late * J_host_direction * so3::hat(meanRate(host, host_late)) * anchor.basis;
    jacobians->J_landmark.col(2) += host_late * J_host_direction * host.v_c;
  }
  return residual;
}

Eigen::Matrix<double, 2, 6> extrinsicJacobian(const BearingMeasurement& measured,
                                              const LandmarkAnchor& anchor,
                                              const ViewGeometry& host, const ViewGeometry& target,
                                              const LandmarkParameters& landmark) {
  const Vector3d direction = directionInHost(anchor, host, landmark);
  const Vector3d h = directionInTarget(host.R_wc * direction, host, target, landmark.z());
  Matrix23d J_h;
  directionResidual(measured, h, &J_h);
  const Matrix23d J_w = J_h * target.R_wc.transpose();
  Matrix26d J;
  J.leftCols<3>() = landmark.z() * J_w * (host.R_wb - target.R_wb);
  J.rightCols<3>() = J_h * so3::hat(h) - J_w * host.R_wc * so3::hat(direction);
  return J;
}

Eigen::Vector2d readoutJacobian(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const ViewGeometry& host, const ViewGeometry& target,
                                const LandmarkParameters& landmark) {
  const double rho = landmark.z();
  const Vector3d direction = anchoredDirection(anchor, landmark);
  const Vector3d h =
      directionInTarget(host.R_wc * directionInHost(anchor, host, landmark), host, target, rho);
  Matrix23d J_h;
  directionResidual(measured, h, &J_h);
  // The rate at the row itself, which is twice as far from the first row's as the mean.
  const Vector3d host_rate =
      anchor.row * directionRate(host, 2.0 * host.readout * anchor.row, direction, rho);
  const Vector3d target_rate =
      measured.row * directionRate(target, 2.0 * target.readout * measured.row, h, rho);
  return J_h * (target.R_wc.transpose() * (host.R_wc * host_rate) - target_rate);
}

Matrix26d intrinsicsJacobian(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                             const ViewGeometry& host, const ViewGeometry& target,
                             const LandmarkParameters& landmark) {
  return intrinsicsJacobianAt(measured,
                              directionWhenSeen(measured, anchor, host, target, landmark));
}

Matrix26d hostIntrinsicsJacobian(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                 const LandmarkParameters& landmark) {
  return intrinsicsJacobianAt(measured, anchoredDirection(anchor, landmark));
}

Eigen::Vector2d hostResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                             const ViewGeometry& host, const LandmarkParameters& landmark,
                             Matrix23d* J_landmark) {
  Matrix23d J_h;
  const Eigen::Vector2d residual =
      directionResidual(measured, anchoredDirection(anchor, landmark), &J_h) +
      intrinsicsResidual(measured, host, anchoredDirection(anchor, landmark));
  if (J_landmark != nullptr) {
    J_landmark->leftCols<2>() = J_h * anchor.basis;
    J_landmark->col(2).setZero();
  }
  return residual;
}

bool BearingFactor::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const Pose T_wh = toPose(parameters[0]);
  const Pose T_wt = toPose(parameters[1]);
  const LandmarkParameters landmark(parameters[2]);
  Eigen::Map<Eigen::Vector2d>{residuals} =
      bearingResidual(measured_, anchor_, movedTo(T_wh, T_bc_, host_view_),
                      movedTo(T_wt, T_bc_, target_view_), landmark, nullptr);
  BearingJacobians J;
  if (jacobians != nullptr) {
    bearingResidual(measured_, anchor_, movedTo(host_.poseForJacobians(T_wh), T_bc_, host_view_),
                    movedTo(target_.poseForJacobians(T_wt), T_bc_, target_view_), landmark, &J);
  }
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
      hostResidual(measured_, anchor_, ViewGeometry(), LandmarkParameters(parameters[0]), &J);
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[0]} = J;
  }
  return true;
}

}  // namespace vins::estimator
