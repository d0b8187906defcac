#pragma once

#include <optional>

#include "vins_estimator/health/rig_error.h"
#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// What the residuals of a solved window tell of errors of the rig. The window's prior and its loop
/// are left out, so that scores of windows that do not overlap are independent: what is asked is
/// whether IMU and bearings of these frames agree with each other. nullopt where a frame stands
/// still, for nothing shows the rig at rest, and where the system cannot be solved. Of the read-out
/// nothing is told where the landmarks do not know the image's height. Takes a few milliseconds.
/// `huber`: see WindowSolverOptions.
std::optional<RigScore> scoreRig(const SlidingWindow& window, double huber);

}  // namespace vins::estimator
