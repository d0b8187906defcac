#pragma once

#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// What a solution must leave behind.
struct OutlierGateOptions {
  double max_squared_residual = 16.0;   ///< of one observation [deviations squared]; 2 dof
  double max_inverse_distance = 20.0;   ///< nearer than 5 cm [1/m]
  double min_inverse_distance = -0.02;  ///< noise of a landmark at infinity may take it below zero
};

/// Takes observations away whose residual is beyond the gate, and the depth of landmarks that came
/// out where none can be. Returns how many observations went.
int removeOutliers(const OutlierGateOptions& options, SlidingWindow* window);

}  // namespace vins::estimator
