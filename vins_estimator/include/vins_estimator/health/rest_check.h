#pragma once

#include "vins_estimator/visual/landmarks.h"

namespace vins::estimator {

/// Whether the camera saw the same from two frames, however long ago the first was: a creep that no
/// half second shows adds up. `max_shift`: what all shared tracks together may have moved, as if
/// the camera had turned, beyond what noise may feign [px]. False where they share fewer than
/// `min_shared` tracks.
bool looksTheSame(const Landmarks& landmarks, FrameId a, FrameId b, double max_shift = 0.3,
                  int min_shared = 15);

}  // namespace vins::estimator
