#pragma once

#include <Eigen/Core>

#include "vins_core/pose.h"

namespace vins::estimator {

/// How still a body stands that is found to stand still.
struct ZeroMotionNoise {
  double velocity = 0.01;   ///< deviation per axis [m/s]
  double position = 0.001;  ///< of the place, from one frame of the rest to another [m]
  double rotation = 1e-4;   ///< of the attitude, likewise [rad]
};

/// Weighted residual of two poses that a resting body has had: position (in the body frame at i)
/// and rotation of T_ij. It knows neither place nor heading in the world. Jacobians, where not
/// null, by the poses' errors (position, rotation on the right).
Eigen::Matrix<double, 6, 1> zeroMotionResidual(const ZeroMotionNoise& noise, const Pose& T_wi,
                                               const Pose& T_wj, Eigen::Matrix<double, 6, 6>* J_i,
                                               Eigen::Matrix<double, 6, 6>* J_j);

}  // namespace vins::estimator
