#pragma once

#include <Eigen/Core>

namespace vins::estimator {

/// Errors of a camera's intrinsic parameters, whatever its model is: relative errors of the focal
/// lengths (x, y), errors of the principal point over the focal lengths (x, y), and errors of the
/// radial distortion's coefficients of r^2 and r^4, all on the plane z = 1 without distortion. The
/// true point there is m - (f_x x, f_y y) - (c_x, c_y) - m (k_1 r^2 + k_2 r^4), to first order.
using CameraIntrinsics = Eigen::Matrix<double, 6, 1>;

/// Derivative of the bearing of a corner by the errors above: 3x6, tangent to the unit bearing.
/// Zero beyond 70 degrees from the optical axis, where the plane z = 1 serves badly.
Eigen::Matrix<double, 3, 6> bearingCorrectionJacobian(const Eigen::Vector3d& bearing);

}  // namespace vins::estimator
