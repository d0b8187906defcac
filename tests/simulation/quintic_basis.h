#pragma once

#include <array>

namespace vins::simulation {

/// A uniform B-spline of degree 5 is, between two knots, a mix of six neighbouring control points.
constexpr int kSplineOrder = 6;

/// Cumulative weights at one place between two knots. The curve is c_0 + sum over j = 1..5 of
/// value[j - 1] (c_j - c_{j-1}): differences only, so that equal control points give a curve that
/// is at rest to the last bit.
struct QuinticWeights {
  std::array<double, kSplineOrder - 1> value{};
  std::array<double, kSplineOrder - 1> first{};   ///< derivative by time [1/s]
  std::array<double, kSplineOrder - 1> second{};  ///< second derivative by time [1/s^2]

  /// Weight of control point j = 0..5 itself.
  double plain(int j) const;
};

/// Weights at the share `u` in [0, 1] of the way between two knots `knot_interval` [s] apart.
/// Sum of the uniform basis functions (K. Qin, "General matrix representations for B-splines",
/// 2000) in the cumulative form of M.-J. Kim et al., "A general construction scheme for unit
/// quaternion curves", 1995.
QuinticWeights quinticWeights(double u, double knot_interval);

}  // namespace vins::simulation
