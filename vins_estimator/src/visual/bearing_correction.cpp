#include "vins_estimator/visual/bearing_correction.h"

namespace vins::estimator {

Eigen::Matrix<double, 3, 6> bearingCorrectionJacobian(const Eigen::Vector3d& bearing) {
  constexpr double kLeastCosine = 0.34;  // 70 degrees
  if (bearing.z() < kLeastCosine) return Eigen::Matrix<double, 3, 6>::Zero();
  const Eigen::Vector2d m = bearing.head<2>() / bearing.z();
  const double r2 = m.squaredNorm();
  Eigen::Matrix<double, 2, 6> J_plane;
  J_plane << -m.x(), 0.0, -1.0, 0.0, -m.x() * r2, -m.x() * r2 * r2,  //
      0.0, -m.y(), 0.0, -1.0, -m.y() * r2, -m.y() * r2 * r2;
  // Of (m, 1) made a unit vector.
  const Eigen::Matrix<double, 3, 2> J_unit =
      bearing.z() * (Eigen::Matrix3d::Identity() - bearing * bearing.transpose()).leftCols<2>();
  return J_unit * J_plane;
}

}  // namespace vins::estimator
