#pragma once

#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <visualization_msgs/MarkerArray.h>

#include "pose_graph/pose_graph.h"

namespace vins::pose_graph {

/// Keyframes of a sequence in the map.
nav_msgs::Path toPath(const SequencePath& path, const std::string& map_frame);

/// Keyframes of a sequence as the odometry has them.
nav_msgs::Path toOdometryPath(const SequencePath& path, const std::string& odom_frame);

/// Steps from keyframe to keyframe as a line for each sequence, and the loops as lines between
/// their ends.
visualization_msgs::MarkerArray toMarkers(const std::vector<SequencePath>& paths,
                                          const std::vector<LoopEdge>& loops,
                                          const std::string& map_frame);

}  // namespace vins::pose_graph
