#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "camera_model/radial_polynomial.h"

namespace vins::camera_model {

/// Radial and tangential lens distortion of the normalized image plane (Brown 1966, in the form and
/// with the order of coefficients k1, k2, p1, p2, k3 of OpenCV).
class RadtanDistortion {
 public:
  /// `reach`: the largest distorted radius in the image, up to which undistort() is fastest.
  RadtanDistortion(const std::array<double, 5>& k1_k2_p1_p2_k3, double reach);

  using Matrix25 = Eigen::Matrix<double, 2, 5>;

  /// Distorted point of an undistorted one; nothing beyond the radius from which on the map cannot
  /// be inverted. With `J_point` and `J_coefficients` (null, or both given) also the derivatives.
  std::optional<Eigen::Vector2d> distort(const Eigen::Vector2d& point, Eigen::Matrix2d* J_point,
                                         Matrix25* J_coefficients) const;

  /// Undistorted point of a distorted one, to 1e-12 of its radius or better (1e-10 next to the
  /// fold); nothing where there is none.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  const std::array<double, 5>& coefficients() const { return k_; }

 private:
  /// The distorted point; with `J`, if not null, its (symmetric) derivative by the point.
  Eigen::Vector2d map(const Eigen::Vector2d& point, Eigen::Matrix2d* J) const;

  /// `point`, where the map's derivative is `J`, is before the fold; `slack` lets rounding pass.
  bool isInvertible(const Eigen::Vector2d& point, const Eigen::Matrix2d& J, double slack) const;

  std::array<double, 5> k_;
  RadialPolynomial radial_;
  double squared_max_radius_;
};

}  // namespace vins::camera_model
