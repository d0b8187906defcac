#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace vins::camera_model {

/// The odd function d(r) = r (1 + c1 r^2 + c2 r^4 + c3 r^6 + c4 r^8) / (1 + b1 r^2 + b2 r^4 +
/// b3 r^6) by which lenses distort a radius or an angle, with its inverse on the range where it
/// rises. With b = 0 it is a polynomial, and costs no division.
class RadialDistortion {
 public:
  /// The range ends at `limit`, or before it where the slope d'(r) first falls below kMinSlope:
  /// from there on the map folds over, and a pixel of noise would be many pixels of direction. It
  /// also ends before a pole, where the denominator falls below kMinDenominator.
  /// Up to the distorted radius `reach`, the image's outermost, inversion is fastest.
  RadialDistortion(const std::array<double, 4>& numerator, double limit, double reach,
                   const std::array<double, 3>& denominator = {});

  static constexpr double kMinSlope = 0.02;
  static constexpr double kMinDenominator = 0.02;

  /// The end of the range in r, and d there.
  double maxRadius() const { return max_radius_; }
  double maxDistorted() const { return max_distorted_; }

  /// d(r) / r of the squared radius.
  double ratio(double squared_radius) const {
    const double s = squared_radius;
    const double numerator = 1.0 + s * (c_[0] + s * (c_[1] + s * (c_[2] + s * c_[3])));
    return is_rational_ ? numerator / denominator(s) : numerator;
  }

  /// Derivative of ratio() by the squared radius.
  double ratioDerivative(double squared_radius) const {
    const double s = squared_radius;
    const double by_numerator = c_[0] + s * (2.0 * c_[1] + s * (3.0 * c_[2] + s * 4.0 * c_[3]));
    if (!is_rational_) return by_numerator;
    return (by_numerator - ratio(s) * denominatorDerivative(s)) / denominator(s);
  }

  /// d'(r) of the squared radius.
  double slope(double squared_radius) const {
    const double s = squared_radius;
    const double numerator =
        1.0 + s * (3.0 * c_[0] + s * (5.0 * c_[1] + s * (7.0 * c_[2] + s * 9.0 * c_[3])));
    if (!is_rational_) return numerator;
    return (numerator - 2.0 * s * ratio(s) * denominatorDerivative(s)) / denominator(s);
  }

  /// 1 + b1 r^2 + b2 r^4 + b3 r^6 of the squared radius.
  double denominator(double squared_radius) const {
    const double s = squared_radius;
    return 1.0 + s * (b_[0] + s * (b_[1] + s * b_[2]));
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
  bool rises(double squared_radius) const;

  double denominatorDerivative(double squared_radius) const {
    const double s = squared_radius;
    return b_[0] + s * (2.0 * b_[1] + s * 3.0 * b_[2]);
  }

  std::array<double, 4> c_;
  std::array<double, 3> b_;
  bool is_rational_;
  double max_radius_ = 0.0;
  double max_distorted_ = 0.0;
  double squared_reach_ = 0.0;  ///< where the table ends
  double nodes_per_squared_distorted_ = 0.0;
  std::vector<double> inverse_ratios_;  ///< at equally spaced squared distorted radii
};

}  // namespace vins::camera_model
