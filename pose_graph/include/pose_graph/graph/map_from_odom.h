#pragma once

#include "vins_core/pose.h"

namespace vins::pose_graph {

/// Where the odometry's world stands in the map: "map -> odom" in ROS's words.
struct MapFromOdom {
  Pose pose;  ///< T_mw, yaw and translation only
  /// What is not known of it, beside the odometry's own errors: position [m], rotation [rad], about
  /// the fixed axes of the map. Zero: the map is this odometry's world.
  se3::Matrix6d covariance = se3::Matrix6d::Zero();
};

}  // namespace vins::pose_graph
