#include "camera_model/radtan_distortion.h"

#include <cmath>

namespace vins::camera_model {
namespace {

constexpr double kLimit = 50.0;  ///< radius of a ray 88.9 degrees from the axis of a pinhole
constexpr int kMaxNewtonSteps = 40;
/// Rounding may push a point on the very edge of the range across it.
constexpr double kEdgeSlack = 1e-6;

/// The smaller eigenvalue of the symmetric J is at least `least`; false may be wrong by a factor of
/// two, for eigenvalues that are alike.
bool stretchesBy(double least, const Eigen::Matrix2d& J) {
  const double determinant = J(0, 0) * J(1, 1) - J(0, 1) * J(0, 1);
  const double trace = J(0, 0) + J(1, 1);
  return trace > 0.0 && determinant >= least * trace;
}

}  // namespace

RadtanDistortion::RadtanDistortion(const Coefficients& coefficients, double reach)
    : k_(coefficients),
      radial_({k_[0], k_[1], k_[4], 0.0}, kLimit, reach, {k_[5], k_[6], k_[7]}),
      squared_max_radius_(radial_.maxRadius() * radial_.maxRadius()) {}

Eigen::Vector2d RadtanDistortion::map(const Eigen::Vector2d& point, Eigen::Matrix2d* J) const {
  const double x = point.x(), y = point.y();
  const double s = x * x + y * y;
  const double ratio = radial_.ratio(s);
  if (J != nullptr) {
    const double d_ratio = 2.0 * radial_.ratioDerivative(s);
    const double tx = 2.0 * k_[3] * x, ty = 2.0 * k_[2] * y;
    const double off = d_ratio * x * y + 2.0 * k_[2] * x + 2.0 * k_[3] * y;
    *J << ratio + d_ratio * x * x + ty + 3.0 * tx, off, off,
        ratio + d_ratio * y * y + 3.0 * ty + tx;
  }
  return {x * ratio + 2.0 * k_[2] * x * y + k_[3] * (s + 2.0 * x * x),
          y * ratio + k_[2] * (s + 2.0 * y * y) + 2.0 * k_[3] * x * y};
}

bool RadtanDistortion::isInvertible(const Eigen::Vector2d& point, const Eigen::Matrix2d& J,
                                    double slack) const {
  return point.squaredNorm() <= squared_max_radius_ * (1.0 + slack) &&
         stretchesBy((1.0 - slack) * RadialDistortion::kMinSlope, J);
}

std::optional<Eigen::Vector2d> RadtanDistortion::distort(const Eigen::Vector2d& point,
                                                         Eigen::Matrix2d* J_point,
                                                         Matrix28* J_coefficients) const {
  if (!(point.squaredNorm() <= squared_max_radius_)) return std::nullopt;
  Eigen::Matrix2d J;
  const Eigen::Vector2d distorted = map(point, &J);
  if (!isInvertible(point, J, 0.0)) return std::nullopt;
  if (J_point != nullptr) *J_point = J;
  if (J_coefficients != nullptr) {
    const double x = point.x(), y = point.y(), s = point.squaredNorm();
    const Eigen::Vector2d by_numerator = point / radial_.denominator(s);
    const Eigen::Vector2d by_denominator = -radial_.ratio(s) * by_numerator;
    *J_coefficients << s * by_numerator, s * s * by_numerator,  //
        Eigen::Vector2d(2.0 * x * y, s + 2.0 * y * y),          //
        Eigen::Vector2d(s + 2.0 * x * x, 2.0 * x * y),          //
        s * s * s * by_numerator, s * by_denominator, s * s * by_denominator,
        s * s * s * by_denominator;
  }
  return distorted;
}

std::optional<Eigen::Vector2d> RadtanDistortion::undistort(const Eigen::Vector2d& distorted) const {
  if (!distorted.allFinite()) return std::nullopt;
  Eigen::Vector2d step = distorted * radial_.nearInverseRatio(distorted.squaredNorm());
  Eigen::Vector2d point = step;
  Eigen::Matrix2d J;
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const Eigen::Vector2d error = distorted - map(point, &J);
    if (!isInvertible(point, J, kEdgeSlack)) {
      // Beyond the fold Newton's method goes astray: back by half of the last step.
      step *= 0.5;
      point -= step;
      continue;
    }
    const double inverse_determinant = 1.0 / (J(0, 0) * J(1, 1) - J(0, 1) * J(0, 1));
    step = {inverse_determinant * (J(1, 1) * error.x() - J(0, 1) * error.y()),
            inverse_determinant * (J(0, 0) * error.y() - J(0, 1) * error.x())};
    point += step;
    // Newton squares the error: what is left after a step of 1e-6 is of the order of 1e-12.
    if (step.squaredNorm() < 1e-12 * (1.0 + point.squaredNorm())) return point;
  }
  return std::nullopt;
}

}  // namespace vins::camera_model
