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

Eigen::Vector2d bearingResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const ViewGeometry& host, const ViewGeometry& target,
                                const LandmarkParameters& landmark, BearingJacobians* jacobians) {
  const double rho = landmark.z();
  const Vector3d direction_w = host.R_wc * anchoredDirection(anchor, landmark);
  const Vector3d h = directionInTarget(direction_w, host, target, rho);
  if (jacobians == nullptr) return directionResidual(measured, h, nullptr);
  Matrix23d J_h;
  const Eigen::Vector2d residual = directionResidual(measured, h, &J_h);
  const Matrix23d J_w = J_h * target.R_wc.transpose();  // by the landmark's place in the world
  // A body's turn moves the landmark by the lever from the body to it, and the other way round.
  const Vector3d from_host = direction_w + rho * (host.p_wc - host.p_wb);
  const Vector3d from_target = direction_w + rho * (host.p_wc - target.p_wb);
  jacobians->J_host.leftCols<3>() = rho * J_w;
  jacobians->J_host.rightCols<3>().noalias() = -(J_w * so3::hat(from_host)) * host.R_wb;
  jacobians->J_target.leftCols<3>() = -rho * J_w;
  jacobians->J_target.rightCols<3>().noalias() = (J_w * so3::hat(from_target)) * target.R_wb;
  jacobians->J_landmark.leftCols<2>().noalias() = (J_w * host.R_wc) * anchor.basis;
  jacobians->J_landmark.col(2).noalias() = J_w * (host.p_wc - target.p_wc);
  return residual;
}

Eigen::Matrix<double, 2, 6> extrinsicJacobian(const BearingMeasurement& measured,
                                              const LandmarkAnchor& anchor,
                                              const ViewGeometry& host, const ViewGeometry& target,
                                              const LandmarkParameters& landmark) {
  const Vector3d direction = anchoredDirection(anchor, landmark);
  const Vector3d h = directionInTarget(host.R_wc * direction, host, target, landmark.z());
  Matrix23d J_h;
  directionResidual(measured, h, &J_h);
  const Matrix23d J_w = J_h * target.R_wc.transpose();
  Matrix26d J;
  J.leftCols<3>() = landmark.z() * J_w * (host.R_wb - target.R_wb);
  J.rightCols<3>() = J_h * so3::hat(h) - J_w * host.R_wc * so3::hat(direction);
  return J;
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
  const Pose T_wh = toPose(parameters[0]);
  const Pose T_wt = toPose(parameters[1]);
  const LandmarkParameters landmark(parameters[2]);
  Eigen::Map<Eigen::Vector2d>{residuals} = bearingResidual(
      measured_, anchor_, viewGeometry(T_wh, T_bc_), viewGeometry(T_wt, T_bc_), landmark, nullptr);
  BearingJacobians J;
  if (jacobians != nullptr) {
    bearingResidual(measured_, anchor_, viewGeometry(host_.poseForJacobians(T_wh), T_bc_),
                    viewGeometry(target_.poseForJacobians(T_wt), T_bc_), landmark, &J);
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
      hostResidual(measured_, anchor_, LandmarkParameters(parameters[0]), &J);
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[0]} = J;
  }
  return true;
}

}  // namespace vins::estimator
