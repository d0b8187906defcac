#pragma once

#include <cstdint>
#include <ostream>
#include <vector>

#include <Eigen/Core>

#include "simulation/euroc_rig.h"
#include "simulation/trajectory_spline.h"
#include "vins_core/imu.h"

namespace vins::simulation {

/// A shaking of the whole sensor, as rotors cause it: eight sinusoids of random phases and axes
/// spread over a narrow band.
struct Vibration {
  double frequency = 90.0;        ///< middle of the band [Hz]; above half the rate it aliases
  double bandwidth = 4.0;         ///< [Hz]
  double acceleration = 0.0;      ///< root mean square per axis [m/s^2]
  double angular_velocity = 0.0;  ///< root mean square per axis [rad/s]
};

/// The simulated sensor. Defaults: EuRoC's ADIS16448, by the densities of its sensor.yaml.
struct ImuOptions {
  double rate = 200.0;  ///< [Hz]
  ImuNoise noise = eurocImuNoise();
  bool noise_free = false;  ///< no white noise, no walk; biases stay what they are at the start
  Eigen::Vector3d initial_accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d initial_gyroscope_bias = Eigen::Vector3d::Zero();      ///< [rad/s]
  double time_offset =
      0.0;  ///< td [s], t_imu = t_cam + td: motion of camera time t is stamped t + td
  std::vector<Vibration> vibrations;
  /// Scale factors (diagonal, 1 without error) and misalignment of the axes: the sensor measures
  /// these times the true specific force and angular velocity.
  Eigen::Matrix3d accelerometer_gain = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d gyroscope_gain = Eigen::Matrix3d::Identity();
  /// The accelerometer's own rate where a driver joins the two sensors: its values are interpolated
  /// to the gyroscope's instants [Hz]; 0: both are one sensor.
  double accelerometer_rate = 0.0;
  double stamp_jitter_s =
      0.0;  ///< standard deviation of the gyroscope's instants about the grid [s]

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const ImuOptions& options);

/// The true biases at one sample.
struct ImuBias {
  Stamp stamp = 0;                                          ///< [ns], the IMU's clock
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyroscope = Eigen::Vector3d::Zero();      ///< [rad/s]
};

/// Samples and, one for each of them, the biases that are in them.
struct ImuRecording {
  std::vector<ImuSample> samples;
  std::vector<ImuBias> biases;
};

/// What the sensor measures from stamp `first` to `last` (IMU's clock, both included), at instants
/// `1/rate` apart from `first` on: the specific force R_bw (a_w - g_w) and the angular velocity,
/// plus vibration, bias and white noise. White noise has the deviation density sqrt(rate), a bias
/// step density / sqrt(rate) (N. Trawny, S. Roumeliotis, "Indirect Kalman filter for 3D attitude
/// estimation", 2005, section 2.2). With an `accelerometer_rate` the accelerometer's own samples
/// are interpolated linearly. White noise, walks and vibrations are random streams of their own:
/// switching one off leaves the others as they are. Throws InputError where the trajectory does not
/// reach over the whole interval.
ImuRecording simulateImu(const TrajectorySpline& trajectory, Stamp first, Stamp last,
                         const ImuOptions& options, std::uint64_t seed);

}  // namespace vins::simulation
