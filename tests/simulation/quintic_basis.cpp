#include "simulation/quintic_basis.h"

namespace vins::simulation {
namespace {

using Polynomial = std::array<double, kSplineOrder>;

/// Coefficients of 1, u, ..., u^5 of the cumulative basis functions 1 to 5, times 120.
constexpr std::array<Polynomial, kSplineOrder - 1> kCumulative = {{
    {119.0, 5.0, -10.0, 10.0, -5.0, 1.0},
    {93.0, 55.0, -30.0, -10.0, 15.0, -4.0},
    {27.0, 55.0, 30.0, -10.0, -15.0, 6.0},
    {1.0, 5.0, 10.0, 10.0, 5.0, -4.0},
    {0.0, 0.0, 0.0, 0.0, 0.0, 1.0},
}};

/// Derivatives 0, 1 and 2 of a polynomial (Horner's scheme, twice differentiated).
std::array<double, 3> evaluate(const Polynomial& c, double u) {
  double value = 0.0, first = 0.0, half_second = 0.0;
  for (int k = kSplineOrder - 1; k >= 0; --k) {
    half_second = half_second * u + first;
    first = first * u + value;
    value = value * u + c[static_cast<std::size_t>(k)];
  }
  return {value, first, 2.0 * half_second};
}

}  // namespace

double QuinticWeights::plain(int j) const {
  const double own = j == 0 ? 1.0 : value[static_cast<std::size_t>(j - 1)];
  const double next = j == kSplineOrder - 1 ? 0.0 : value[static_cast<std::size_t>(j)];
  return own - next;
}

QuinticWeights quinticWeights(double u, double knot_interval) {
  QuinticWeights weights;
  for (std::size_t j = 0; j < kCumulative.size(); ++j) {
    const auto derivatives = evaluate(kCumulative[j], u);
    weights.value[j] = derivatives[0] / 120.0;
    weights.first[j] = derivatives[1] / (120.0 * knot_interval);
    weights.second[j] = derivatives[2] / (120.0 * knot_interval * knot_interval);
  }
  return weights;
}

}  // namespace vins::simulation
