#pragma once

#include "vins_estimator/window/window_solver.h"

namespace vins::estimator {

/// Motion-only visual-inertial bundle adjustment: moves the frames after the newest keyframe only,
/// with all else as it stands - keyframes, landmarks, calibration (VINS-Mono, section VI-E). Costs
/// a tenth of solveWindow(). The covariance of the newest state, which no longer knows the window's
/// information, is the last keyframe's, carried on by the IMU: too large rather than too small.
SolveSummary solveNewestFrames(const WindowSolverOptions& options, SlidingWindow* window);

}  // namespace vins::estimator
