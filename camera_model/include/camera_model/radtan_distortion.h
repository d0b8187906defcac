#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "camera_model/radial_distortion.h"

namespace vins::camera_model {

/// Radial and tangential lens distortion of the normalized image plane (Brown 1966, in the form and
/// with the order of coefficients k1, k2, p1, p2, k3, k4, k5, k6 of OpenCV): the point (x, y) at
/// the radius r goes to (x, y) (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6) and
/// is moved by (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y). Without the last three
/// the distortion is a polynomial.
class RadtanDistortion {
 public:
  using Coefficients = std::array<double, 8>;  ///< in the order above

  /// `reach`: the largest distorted radius in the image, up to which undistort() is fastest.
  RadtanDistortion(const Coefficients& coefficients, double reach);

  using Matrix28 = Eigen::Matrix<double, 2, 8>;

  /// Distorted point of an undistorted one; nothing beyond the radius from which on the map cannot
  /// be inverted. With `J_point` and `J_coefficients` (null, or both given) also the derivatives.
  std::optional<Eigen::Vector2d> distort(const Eigen::Vector2d& point, Eigen::Matrix2d* J_point,
                                         Matrix28* J_coefficients) const;

  /// Undistorted point of a distorted one, to 1e-12 of its radius or better (1e-10 next to the
  /// fold); nothing where there is none.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  const Coefficients& coefficients() const { return k_; }

 private:
  /// The distorted point; with `J`, if not null, its (symmetric) derivative by the point.
  Eigen::Vector2d map(const Eigen::Vector2d& point, Eigen::Matrix2d* J) const;

  /// `point`, where the map's derivative is `J`, is before the fold; `slack` lets rounding pass.
  bool isInvertible(const Eigen::Vector2d& point, const Eigen::Matrix2d& J, double slack) const;

  Coefficients k_;
  RadialDistortion radial_;
  double squared_max_radius_;
};

}  // namespace vins::camera_model
