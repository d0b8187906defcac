#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace vins::camera_model {

/// The odd polynomial d(r) = r (1 + c1 r^2 + c2 r^4 + c3 r^6 + c4 r^8) by which lenses distort a
/// radius or an angle, with its inverse on the range where it rises.
class RadialPolynomial {
 public:
  /// The range ends at `limit`, or before it where the slope d'(r) first falls below kMinSlope:
  /// from there on the map folds over, and a pixel of noise would be many pixels of direction.
  /// Up to the distorted radius `reach`, the image's outermost, inversion is fastest.
  RadialPolynomial(const std::array<double, 4>& coefficients, double limit, double reach);

  static constexpr double kMinSlope = 0.02;

  /// The end of the range in r, and d there.
  double maxRadius() const { return max_radius_; }
  double maxDistorted() const { return max_distorted_; }

  /// d(r) / r of the squared radius.
  double ratio(double squared_radius) const {
    const double s = squared_radius;
    return 1.0 + s * (c_[0] + s * (c_[1] + s * (c_[2] + s * c_[3])));
  }

  /// d'(r) of the squared radius.
  double slope(double squared_radius) const {
    const double s = squared_radius;
    return 1.0 + s * (3.0 * c_[0] + s * (5.0 * c_[1] + s * (7.0 * c_[2] + s * 9.0 * c_[3])));
  }

  /// About r / d(r) of the squared distorted radius: a start for Newton's method, right to 1e-4 or
  /// better. Within reach it comes from a table; beyond the range it is the value at its end.
  double nearInverseRatio(double squared_distorted) const {
    if (!(squared_distorted < squared_reach_)) return inverseRatioBeyondReach(squared_distorted);
    const double position = squared_distorted * nodes_per_squared_distorted_;
    const auto i = static_cast<std::size_t>(position);
    const double share = position - static_cast<double>(i);
    return inverse_ratios_[i] + share * (inverse_ratios_[i + 1] - inverse_ratios_[i]);
  }

  /// r with d(r) = distorted, to rounding; nothing beyond the range.
  std::optional<double> invert(double distorted) const;

 private:
  double inverseRatioBeyondReach(double squared_distorted) const;
  double invertByBisection(double distorted) const;
  double findMaxRadius(double limit) const;
  void fillTable(double reach);

  std::array<double, 4> c_;
  double max_radius_ = 0.0;
  double max_distorted_ = 0.0;
  double squared_reach_ = 0.0;  ///< where the table ends
  double nodes_per_squared_distorted_ = 0.0;
  std::vector<double> inverse_ratios_;  ///< at equally spaced squared distorted radii
};

}  // namespace vins::camera_model
