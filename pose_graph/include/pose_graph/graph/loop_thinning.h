#pragma once

#include <vector>

#include "pose_graph/graph/keyframe_graph.h"
#include "pose_graph/graph/thinning.h"

namespace vins::pose_graph {

/// Loops that can leave once a map has more than its options allow, so many that `thin_to` of these
/// are left: one after the other that which another one repeats most. Two loops between the same
/// two runs of the odometry are as far apart as the time that the odometry needs from end to end,
/// hypot of both ends: the shorter, the less it can drift in it and the more the two say the same.
/// Of two as close as each other the older leaves. The last loop between two runs never does, so no
/// map falls apart. The same on every run.
std::vector<LoopEdge> redundantLoops(const KeyframeGraph& graph, const ThinningOptions& options);

}  // namespace vins::pose_graph
