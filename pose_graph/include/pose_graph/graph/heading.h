#pragma once

#include "vins_core/heading.h"
#include "vins_core/pose.h"

namespace vins::pose_graph {

/// T_mw of a keyframe: the transform with yaw only that takes its pose in the odometry's world to
/// its pose in the map, T_mb = T_mw T_wb, for poses that differ by such a transform.
Pose driftOf(const Pose& T_mb, const Pose& T_wb);

}  // namespace vins::pose_graph
