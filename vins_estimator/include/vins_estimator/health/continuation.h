#pragma once

#include <deque>
#include <optional>

#include "vins_core/imu.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/initialization/initialization.h"

namespace vins::estimator {

/// Carries the last credible state over a reset, so that the odometry goes on where it was instead
/// of jumping to the origin. The IMU alone carries it on for a second; then the body is taken to
/// stand where it was, while the gyroscope still knows the yaw. What is not known of the way grows
/// the deviations.
class Continuation {
 public:
  /// `noise`: for the gravity and the drift of the yaw.
  explicit Continuation(const ImuNoise& noise) : noise_(noise) {}

  /// The last credible state, at `stamp` [ns], its covariance by ErrorState.
  void start(Stamp stamp, const NavState& state, const Matrix15d& covariance);
  bool isActive() const { return !entries_.empty(); }
  void clear() { entries_.clear(); }

  /// Carries on to the frame, by the samples since the last one.
  void addFrame(const FrameMeasurements& measurements);

  /// Moves the new first states to where the body was last known to be: by position and yaw, with
  /// deviations to match. Does nothing where there is nothing to go on from.
  void apply(Initialization* initialization) const;

 private:
  struct Entry {
    Stamp stamp = 0;
    NavState state;
    double position_sigma = 0.0;  ///< per axis [m]
    double yaw_sigma = 0.0;       ///< [rad]
  };
  const Entry& at(Stamp stamp) const;

  ImuNoise noise_;
  double carried_ = 0.0;  ///< by the IMU so far [s]
  std::deque<Entry> entries_;
};

/// Moves new first states so that the newest of them stands where `newest` does, by position and
/// yaw. It is then as uncertain as `covariance` says: what the new states' own measurements make of
/// it, and a doubt about where they begin for the rest. `share`: of the variance that is the former.
void moveNewestTo(const NavState& newest, const Matrix15d& covariance, double share,
                  Initialization* initialization);

}  // namespace vins::estimator
