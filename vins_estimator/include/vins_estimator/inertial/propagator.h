#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include "vins_core/imu.h"
#include "vins_core/sample_period.h"
#include "vins_core/time.h"
#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// A state carried by the IMU from the last solved one.
struct PropagatedState {
  Stamp stamp = 0;  ///< the IMU sample's [ns, the IMU's clock]
  NavState state;
  Eigen::Vector3d angular_velocity_b = Eigen::Vector3d::Zero();  ///< free of bias [rad/s]
  double angular_velocity_variance = 0.0;    ///< of the white noise in it, per axis [rad^2/s^2]
  Matrix15d covariance = Matrix15d::Zero();  ///< of `state`, by ErrorState
  double horizon = 0.0;                      ///< since the solved state [s]
};

/// Options of the propagator.
struct PropagatorOptions {
  double max_horizon = 10.0;  ///< without a new solved state, for longer: nothing [s]

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// Odometry at the IMU's rate: the last solved state, carried to each sample by the midpoint rule,
/// with its covariance. Samples that are newer than a solved state wait for it and are gone through
/// again when it comes. (Error-state equations: J. Sola, "Quaternion kinematics for the error-state
/// Kalman filter", 2017, section 5.4, with local angular errors.) Not safe to be called from two
/// threads at once.
class Propagator {
 public:
  /// Throws InputError for bad noise or options.
  explicit Propagator(const ImuNoise& noise, const PropagatorOptions& options = {});

  /// A new solved state at `stamp` [ns, the IMU's clock], with its biases and covariance (by
  /// ErrorState). A state that is not finite or older than the one before is ignored.
  void setState(Stamp stamp, const NavState& state, const Matrix15d& covariance);

  /// The state at the sample, or nothing: without a solved state, for samples that are not finite
  /// or do not rise, and beyond the horizon.
  std::optional<PropagatedState> addImu(const ImuSample& sample);

  /// Forgets state and samples.
  void reset();

  std::size_t sampleCount() const { return samples_.size(); }

 private:
  void replay();
  /// Carries the current state to sample `index` of the buffer.
  void advanceTo(std::size_t index);
  void step(const ImuSample& from, const ImuSample& to, double dt);
  void propagateCovariance(double dt, const Eigen::Vector3d& f_w, const Eigen::Matrix3d& R_wb,
                           const Eigen::Matrix3d& turn);
  /// What one step's noise adds, where the transition is F.
  Matrix15d stepNoise(double dt, const Matrix15d& F) const;
  void noteAngularVelocity(const ImuSample& sample);
  void boundBuffer();

  ImuNoise noise_;
  PropagatorOptions options_;
  std::deque<ImuSample> samples_;  ///< from the last one not after the solved state
  SamplePeriod period_;
  std::optional<Stamp> solved_;
  PropagatedState current_;
};

}  // namespace vins::estimator
