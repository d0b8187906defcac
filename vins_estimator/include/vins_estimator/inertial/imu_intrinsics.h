#pragma once

#include <Eigen/Core>

namespace vins::estimator {

/// Scale and misalignment errors of an IMU's axes. The true specific force is G_a (a_m - b_a), the
/// true angular velocity G_g (w_m - b_g), with a_m, w_m the readings and b_a, b_g the biases. G_a
/// is the identity plus a lower triangular matrix (xx, yx, yy, zx, zy, zz), which makes the
/// accelerometer's axes define the body frame; G_g is the identity plus a full matrix, by rows. The
/// triangular form is the one of J. Rehder et al., "Extending kalibr: Calibrating the extrinsics of
/// multiple IMUs and of individual axes", ICRA 2016. All zero: a sensor without these errors.
using ImuIntrinsics = Eigen::Matrix<double, 15, 1>;

constexpr int kAccelerometerIntrinsics = 6;  ///< entries of G_a, first; those of G_g follow

/// G_a of these errors.
Eigen::Matrix3d accelerometerGain(const ImuIntrinsics& errors);
/// G_g of these errors.
Eigen::Matrix3d gyroscopeGain(const ImuIntrinsics& errors);

/// Derivative of G_a a by the first six errors; `a`: a reading without its bias [m/s^2].
Eigen::Matrix<double, 3, 6> accelerometerGainJacobian(const Eigen::Vector3d& a);
/// Derivative of G_g w by the last nine errors; `w`: a reading without its bias [rad/s].
Eigen::Matrix<double, 3, 9> gyroscopeGainJacobian(const Eigen::Vector3d& w);

}  // namespace vins::estimator
