#pragma once

#include <cmath>

namespace vins {

/// Below this squared angle [rad^2] the closed forms of the coefficients lose digits to
/// cancellation; kSeriesTerms terms of the series are then exact to double precision.
constexpr double kSeriesBelowSquared = 0.25;
constexpr int kSeriesTerms = 8;

/// Sum over j of (-1)^j t^j / (2j + n)!, with t the squared angle: what is left of cosine (n even)
/// or sine (n odd) when its first terms are taken away. n = 2: (1 - cos a) / a^2;
/// n = 3: (a - sin a) / a^3; n = 4: (a^2 / 2 + cos a - 1) / a^4.
inline double trigonometricTail(double squared_angle, int n) {
  double term = 1.0;
  for (int i = 2; i <= n; ++i) term /= i;
  double sum = 0.0;
  for (int j = 0; j < kSeriesTerms; ++j) {
    sum += term;
    term *= -squared_angle / ((2 * j + n + 1) * (2 * j + n + 2));
  }
  return sum;
}

/// (a - sin a) / a^3 for all angles.
inline double angleMinusSine(double squared_angle) {
  if (squared_angle < kSeriesBelowSquared) return trigonometricTail(squared_angle, 3);
  const double angle = std::sqrt(squared_angle);
  return (angle - std::sin(angle)) / (squared_angle * angle);
}

}  // namespace vins
