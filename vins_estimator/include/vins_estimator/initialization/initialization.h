#pragma once

#include <vector>

#include "vins_core/feature_frame.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"

namespace vins::estimator {

/// A frame of the first window.
struct InitialFrame {
  FeatureFrame features;
  NavState state;
  Preintegration imu;  ///< from the frame before; empty for the first
  Eigen::Vector3d measured_rate = Eigen::Vector3d::Zero();  ///< of the gyroscope, then [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< then [rad/s^2]
  double undone_readout = 0.0;  ///< of the rolling shutter, before [s]
};

/// The states with which the estimator starts.
struct Initialization {
  std::vector<InitialFrame> frames;  ///< oldest first; at most as many as the options say
  double scale_sigma = 0.0;          ///< relative deviation of the scale; 0 at rest
  bool at_rest = false;  ///< all frames stood still: velocities are zero, positions equal
  /// What was known of the first state before the frames' own measurements, which the window counts
  /// itself: mean and deviations of its errors by ErrorState, those of the rotation about the
  /// world's axes. Position and yaw (about z) are set by convention, not estimated.
  NavState mean;
  Vector15d sigma = Vector15d::Ones();
};

}  // namespace vins::estimator
