#pragma once

#include <optional>

#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// What a state must keep to be credible. No vehicle that carries a camera to look with comes near
/// these figures while the estimate is sound.
struct FailureDetectorOptions {
  double max_accelerometer_bias = 2.5;  ///< [m/s^2]
  double max_gyroscope_bias = 1.0;      ///< [rad/s]
  double max_speed = 100.0;             ///< [m/s]
  double max_jump = 3.0;                ///< of the position, from where the IMU predicted it [m]
  double max_turn = 0.8;                ///< of the attitude, likewise [rad]
  double max_velocity_sigma = 3.0;      ///< largest, by the covariance: lost on the IMU alone [m/s]

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// What is wrong with a state.
struct Failure {
  const char* reason = "";  ///< for people: "the accelerometer bias is too large"
  const char* figure = "";  ///< its name, unit in it
  double value = 0.0;
};

/// Judges a state that was predicted by the IMU and then solved, with its covariance by ErrorState.
std::optional<Failure> detectFailure(const FailureDetectorOptions& options,
                                     const NavState& predicted, const NavState& solved,
                                     const Matrix15d& covariance);

}  // namespace vins::estimator
