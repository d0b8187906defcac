#pragma once

#include <ostream>

#include <Eigen/Core>

#include "vins_core/time.h"

namespace vins {

/// One reading of the inertial sensor, in the body frame (body = IMU).
struct ImuSample {
  Stamp stamp = 0;                                             ///< [ns], the IMU's clock
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< specific force [m/s^2]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]

  /// No component is NaN or infinite.
  bool isFinite() const { return acceleration.allFinite() && angular_velocity.allFinite(); }
};

/// The reading at `stamp` on the straight line between two, whose stamps differ.
ImuSample interpolate(const ImuSample& from, const ImuSample& to, Stamp stamp);

/// Estimated biases of the inertial sensor with their covariances, in the body frame.
struct ImuBiasEstimate {
  Stamp stamp = 0;                                                     ///< [ns]
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();             ///< [m/s^2]
  Eigen::Vector3d gyroscope = Eigen::Vector3d::Zero();                 ///< [rad/s]
  Eigen::Matrix3d accelerometer_covariance = Eigen::Matrix3d::Zero();  ///< [m^2/s^4]
  Eigen::Matrix3d gyroscope_covariance = Eigen::Matrix3d::Zero();      ///< [rad^2/s^2]
};

/// Noise model of the inertial sensor: white noise and random-walk biases, as continuous-time
/// densities (IEEE Std 952; in VINS-Mono's configuration: acc_n, gyr_n, acc_w, gyr_w, g_norm).
struct ImuNoise {
  double accelerometer_noise = 0.08;    ///< acc_n [m/s^2/sqrt(Hz)]
  double gyroscope_noise = 0.004;       ///< gyr_n [rad/s/sqrt(Hz)]
  double accelerometer_walk = 0.00004;  ///< acc_w [m/s^3/sqrt(Hz)]
  double gyroscope_walk = 2.0e-6;       ///< gyr_w [rad/s^2/sqrt(Hz)]
  double gravity = 9.81;                ///< g_norm, magnitude [m/s^2]
  /// Rotors shake an accelerometer by many times its noise. The shaking is no white noise: most of
  /// it averages out within a few periods, this share of its amplitude does not (vibration_share).
  double vibration_share = 0.2;

  /// Variance of the white noise of one gyroscope reading, per axis [rad^2/s^2], where readings
  /// come every `period` [s].
  double gyroscopeVariance(double period) const {
    return gyroscope_noise * gyroscope_noise / period;
  }

  /// Throws InputError naming the first value that is not positive and finite.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const ImuNoise& noise);

}  // namespace vins
