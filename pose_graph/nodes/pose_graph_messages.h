#pragma once

#include <string>
#include <vector>

#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <visualization_msgs/MarkerArray.h>

#include "pose_graph/graph/map_from_odom.h"
#include "pose_graph/pose_graph.h"

namespace vins::pose_graph {

/// The odometry moved into the map: pose and covariance about the fixed axes of `map_frame`; the
/// twist stays as it is. Throws InputError where the message's pose is none.
nav_msgs::Odometry toMapOdometry(const nav_msgs::Odometry& odometry,
                                 const MapFromOdom& map_from_odom, const std::string& map_frame);

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
