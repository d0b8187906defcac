#include "pose_graph/graph/heading.h"

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

Pose driftOf(const Pose& T_mb, const Pose& T_wb) {
  const Eigen::Quaterniond R_mw = yawRotation(yawOf(T_mb.rotation * T_wb.rotation.conjugate()));
  return {R_mw, T_mb.position - R_mw * T_wb.position};
}

}  // namespace vins
