#include "vins_core/so3.h"

#include <cmath>

#include "trigonometric_series.h"

namespace vins::so3 {
namespace {

/// (1 - cos a) / a^2, written with the half angle: no cancellation.
double oneMinusCosine(double squared_angle) {
  if (squared_angle < kSeriesBelowSquared) return trigonometricTail(squared_angle, 2);
  const double half_sine = std::sin(0.5 * std::sqrt(squared_angle));
  return 2.0 * half_sine * half_sine / squared_angle;
}

/// (1 - (a/2) cot(a/2)) / a^2: the coefficient of hat(phi)^2 in the inverse Jacobians.
double halfCotangent(double squared_angle) {
  if (squared_angle < kSeriesBelowSquared) {
    // Bernoulli numbers B_2k / (2k)! from k = 1.
    constexpr double kTerms[] = {1.0 / 12.0,          1.0 / 720.0,
                                 1.0 / 30240.0,       1.0 / 1209600.0,
                                 1.0 / 47900160.0,    691.0 / 1307674368000.0,
                                 1.0 / 74724249600.0, 3617.0 / 10670622842880000.0};
    double sum = 0.0;
    for (int i = 7; i >= 0; --i) sum = sum * squared_angle + kTerms[i];
    return sum;
  }
  const double half = 0.5 * std::sqrt(squared_angle);
  return (1.0 - half * std::cos(half) / std::sin(half)) / squared_angle;
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d skew;
  skew << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return skew;
}

Eigen::Vector3d vee(const Eigen::Matrix3d& skew) {
  return 0.5 *
         Eigen::Vector3d(skew(2, 1) - skew(1, 2), skew(0, 2) - skew(2, 0), skew(1, 0) - skew(0, 1));
}

Eigen::Quaterniond exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double half = 0.5 * angle;
  // sin(x) / x is computed without loss for every x that is not zero.
  const double scale = angle > 0.0 ? std::sin(half) / angle : 0.5;
  return {std::cos(half), scale * phi.x(), scale * phi.y(), scale * phi.z()};
}

Eigen::Vector3d log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double cosine = sign * q.w();
  if (sine == 0.0) return Eigen::Vector3d::Zero();
  return (sign * 2.0 * std::atan2(sine, cosine) / sine) * q.vec();
}

Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi) {
  const double squared_angle = phi.squaredNorm();
  const Eigen::Matrix3d phi_hat = hat(phi);
  return Eigen::Matrix3d::Identity() + oneMinusCosine(squared_angle) * phi_hat +
         angleMinusSine(squared_angle) * phi_hat * phi_hat;
}

Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& phi) {
  const Eigen::Matrix3d phi_hat = hat(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * phi_hat +
         halfCotangent(phi.squaredNorm()) * phi_hat * phi_hat;
}

Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi) { return leftJacobian(-phi); }

Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi) {
  return leftJacobianInverse(-phi);
}

}  // namespace vins::so3
