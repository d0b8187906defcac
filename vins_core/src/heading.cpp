#include "vins_core/heading.h"

#include <cmath>

namespace vins {

double wrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * M_PI);
  return wrapped <= -M_PI ? wrapped + 2.0 * M_PI : wrapped;
}

Eigen::Quaterniond yawRotation(double yaw) {
  return {std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw)};
}

double yawOf(const Eigen::Quaterniond& R) { return wrapAngle(2.0 * std::atan2(R.z(), R.w())); }

}  // namespace vins
