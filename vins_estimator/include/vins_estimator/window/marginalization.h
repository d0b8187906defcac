#pragma once

#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// Turns what is known of the oldest frame into a prior on the frames that stay, and takes it out:
/// its IMU interval to the next frame, the prior so far, and the landmarks it hosts that are no
/// longer tracked. Landmarks that are still tracked stay and lose this one observation (S.
/// Leutenegger et al., "Keyframe-based visual-inertial odometry using nonlinear optimization", IJRR
/// 2015, section 3.4.3), since no measurement may count twice. Elimination by QR keeps the prior in
/// square-root form (N. Demmel et al., "Square root marginalization for sliding-window bundle
/// adjustment", ICCV 2021). The states that the prior touches keep their first estimates. `huber`:
/// see WindowSolverOptions.
void marginalizeOldest(double huber, SlidingWindow* window);

}  // namespace vins::estimator
