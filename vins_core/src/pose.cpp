#include "vins_core/pose.h"

#include <cmath>

#include <Eigen/SVD>

#include "trigonometric_series.h"
#include "vins_core/so3.h"

namespace vins {

Pose Pose::operator*(const Pose& T_bc) const {
  return {(rotation * T_bc.rotation).normalized(), rotation * T_bc.position + position};
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond R_ba = rotation.conjugate();
  return {R_ba, -(R_ba * position)};
}

Eigen::Matrix4d Pose::matrix() const {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  T.topRightCorner<3, 1>() = position;
  return T;
}

Pose poseFromMatrix(const Eigen::Matrix4d& T_ab) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(T_ab.topLeftCorner<3, 3>(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  if (R.determinant() < 0.0) {
    R = svd.matrixU() * Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal() * svd.matrixV().transpose();
  }
  return {Eigen::Quaterniond(R).normalized(), T_ab.topRightCorner<3, 1>()};
}

namespace se3 {
namespace {

/// (a^2 / 2 + cos a - 1) / a^4.
double cosineTail(double squared_angle) {
  if (squared_angle < kSeriesBelowSquared) return trigonometricTail(squared_angle, 4);
  return (0.5 * squared_angle + std::cos(std::sqrt(squared_angle)) - 1.0) /
         (squared_angle * squared_angle);
}

/// (2 a - 3 sin a + a cos a) / (2 a^5).
double mixedTail(double squared_angle) {
  if (squared_angle < kSeriesBelowSquared) {
    double term = 1.0 / 120.0;  // (-1)^j a^2j / (2j + 5)!, each taken j + 1 times
    double sum = 0.0;
    for (int j = 0; j < kSeriesTerms; ++j) {
      sum += (j + 1) * term;
      term *= -squared_angle / ((2 * j + 6) * (2 * j + 7));
    }
    return sum;
  }
  const double angle = std::sqrt(squared_angle);
  return (2.0 * angle - 3.0 * std::sin(angle) + angle * std::cos(angle)) /
         (2.0 * squared_angle * squared_angle * angle);
}

/// The off-diagonal block Q of the left Jacobian (Barfoot, equation 7.86b).
Eigen::Matrix3d leftJacobianCoupling(const Vector6d& xi) {
  const Eigen::Matrix3d rho = so3::hat(xi.head<3>());
  const Eigen::Matrix3d phi = so3::hat(xi.tail<3>());
  const double squared_angle = xi.tail<3>().squaredNorm();
  const Eigen::Matrix3d phi_rho = phi * rho;
  const Eigen::Matrix3d rho_phi = rho * phi;
  const Eigen::Matrix3d phi_rho_phi = phi_rho * phi;
  return 0.5 * rho + angleMinusSine(squared_angle) * (phi_rho + rho_phi + phi_rho_phi) +
         cosineTail(squared_angle) * (phi * phi_rho + rho_phi * phi - 3.0 * phi_rho_phi) +
         mixedTail(squared_angle) * (phi_rho_phi * phi + phi * phi_rho_phi);
}

}  // namespace

Pose exp(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return {so3::exp(phi), so3::leftJacobian(phi) * xi.head<3>()};
}

Vector6d log(const Pose& T) {
  Vector6d xi;
  xi.tail<3>() = so3::log(T.rotation);
  xi.head<3>() = so3::leftJacobianInverse(xi.tail<3>()) * T.position;
  return xi;
}

Matrix6d adjoint(const Pose& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = R;
  Ad.topRightCorner<3, 3>() = so3::hat(T.position) * R;
  Ad.bottomRightCorner<3, 3>() = R;
  return Ad;
}

Matrix6d rightJacobian(const Vector6d& xi) {
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = so3::rightJacobian(xi.tail<3>());
  J.topRightCorner<3, 3>() = leftJacobianCoupling(-xi);
  J.bottomRightCorner<3, 3>() = J.topLeftCorner<3, 3>();
  return J;
}

Matrix6d rightJacobianInverse(const Vector6d& xi) {
  const Eigen::Matrix3d J_inverse = so3::rightJacobianInverse(xi.tail<3>());
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = J_inverse;
  J.topRightCorner<3, 3>() = -J_inverse * leftJacobianCoupling(-xi) * J_inverse;
  J.bottomRightCorner<3, 3>() = J_inverse;
  return J;
}

}  // namespace se3
}  // namespace vins
