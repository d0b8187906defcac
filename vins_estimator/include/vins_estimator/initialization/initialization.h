#pragma once

#include <vector>

#include "vins_core/feature_frame.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"

namespace vins {

/// A frame of the first window.
struct InitialFrame {
  FeatureFrame features;
  NavState state;
  Preintegration imu;  ///< from the frame before; empty for the first
};

/// The states with which the estimator starts.
struct Initialization {
  std::vector<InitialFrame> frames;  ///< oldest first; at most as many as the options say
  bool at_rest = false;  ///< all frames stood still: velocities are zero, positions equal
  Vector15d sigma = Vector15d::Zero();  ///< deviations of the first state's errors, by ErrorState;
                                        ///< position and yaw are set by convention, not estimated
};

}  // namespace vins
