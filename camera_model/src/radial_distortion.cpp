#include "camera_model/radial_distortion.h"

#include <algorithm>
#include <cmath>

namespace vins::camera_model {
namespace {

constexpr int kNodes = 257;
constexpr int kMaxNewtonSteps = 40;
/// Newton squares the error: after a step this small none is left.
constexpr double kLastStep = 1e-7;

}  // namespace

RadialDistortion::RadialDistortion(const std::array<double, 4>& numerator, double limit,
                                   double reach, const std::array<double, 3>& denominator)
    : c_(numerator),
      b_(denominator),
      is_rational_(denominator != std::array<double, 3>{}),
      max_radius_(findMaxRadius(limit)) {
  max_distorted_ = max_radius_ * ratio(max_radius_ * max_radius_);
  fillTable(reach);
}

bool RadialDistortion::rises(double squared_radius) const {
  return slope(squared_radius) >= kMinSlope &&
         !(is_rational_ && denominator(squared_radius) < kMinDenominator);
}

double RadialDistortion::findMaxRadius(double limit) const {
  // Steps of 0.5 % find every dip of the slope that is wide enough to matter; bisection its edge.
  double inside = 0.0;
  for (double r = 1e-3; inside < limit; r *= 1.005) {
    double outside = std::min(r, limit);
    if (!rises(outside * outside)) {
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + outside);
        (rises(middle * middle) ? inside : outside) = middle;
      }
      return inside;
    }
    inside = outside;
  }
  return limit;
}

double RadialDistortion::invertByBisection(double distorted) const {
  double low = 0.0;
  double high = max_radius_;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * ratio(middle * middle) < distorted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void RadialDistortion::fillTable(double reach) {
  inverse_ratios_.resize(kNodes, 1.0);
  const double end = std::clamp(reach, 1e-3, max_distorted_);
  squared_reach_ = end * end;
  nodes_per_squared_distorted_ = (kNodes - 1) / squared_reach_;
  for (int i = 1; i < kNodes; ++i) {
    const double distorted = std::sqrt(squared_reach_ * i / (kNodes - 1));
    inverse_ratios_[i] = invertByBisection(distorted) / distorted;
  }
}

double RadialDistortion::inverseRatioBeyondReach(double squared_distorted) const {
  const double distorted = std::min(std::sqrt(squared_distorted), max_distorted_);
  return invertByBisection(distorted) / distorted;
}

std::optional<double> RadialDistortion::invert(double distorted) const {
  if (!(distorted <= max_distorted_)) return std::nullopt;
  double r = distorted * nearInverseRatio(distorted * distorted);
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const double s = r * r;
    const double step = (distorted - r * ratio(s)) / slope(s);
    r = std::min(r + step, max_radius_);
    if (std::abs(step) < kLastStep) break;
  }
  return r;
}

}  // namespace vins::camera_model
