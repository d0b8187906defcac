#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vins_core/keyframe.h"
#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// A landmark of the window in the world, for pictures.
struct LandmarkPoint {
  std::int64_t id = 0;
  Eigen::Vector3d position_w = Eigen::Vector3d::Zero();  ///< [m]
};

/// All landmarks that have depth.
std::vector<LandmarkPoint> landmarkPoints(const SlidingWindow& window);

/// Frame `index` of the window as a keyframe, with the landmarks that it sees.
Keyframe keyframeOf(const SlidingWindow& window, std::size_t index, std::uint32_t sequence);

/// The last word on a keyframe that is about to leave.
KeyframePoseUpdate poseUpdateOf(const SlidingWindow& window, const WindowFrame& frame,
                                std::uint32_t sequence);

}  // namespace vins::estimator
