#pragma once

#include "vins_estimator/initialization/initialization.h"
#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// Puts the first states into an empty window, which has its landmarks' noise, extrinsic and
/// gravity already: frames numbered from `first_id` on, their tracks, and a prior on the first
/// state by the deviations given.
void startWindow(const Initialization& initialization, FrameId first_id, SlidingWindow* window);

/// Gives depth to tracks whose rays now meet well enough. Returns how many got it.
int triangulateTracks(SlidingWindow* window);

}  // namespace vins::estimator
