#include "pose_graph_messages.h"

#include <map>

#include "vins_msgs/odometry.h"

namespace vins::pose_graph {
namespace {

geometry_msgs::PoseStamped stamped(Stamp stamp, const Pose& pose, const std::string& frame) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = vins_msgs::toRosTime(stamp);
  message.header.frame_id = frame;
  message.pose = vins_msgs::toMsg(pose);
  return message;
}

nav_msgs::Path pathOf(const SequencePath& path, const Pose KeyframeVertex::*pose,
                      const std::string& frame) {
  nav_msgs::Path message;
  message.header.frame_id = frame;
  for (const KeyframeVertex& keyframe : path.keyframes) {
    message.poses.push_back(stamped(keyframe.stamp, keyframe.*pose, frame));
  }
  if (!message.poses.empty()) message.header.stamp = message.poses.back().header.stamp;
  return message;
}

visualization_msgs::Marker line(const std::string& name, int id, int type,
                                const std::string& frame) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.02;
  marker.color.a = 1.0F;
  return marker;
}

}  // namespace

nav_msgs::Odometry toMapOdometry(const nav_msgs::Odometry& odometry,
                                 const MapFromOdom& map_from_odom, const std::string& map_frame) {
  return vins_msgs::inParentFrame(odometry, map_frame, map_from_odom.pose,
                                  map_from_odom.covariance);
}

nav_msgs::Path toPath(const SequencePath& path, const std::string& map_frame) {
  return pathOf(path, &KeyframeVertex::T_mb, map_frame);
}

nav_msgs::Path toOdometryPath(const SequencePath& path, const std::string& odom_frame) {
  return pathOf(path, &KeyframeVertex::T_wb, odom_frame);
}

visualization_msgs::MarkerArray toMarkers(const std::vector<SequencePath>& paths,
                                          const std::vector<LoopEdge>& loops,
                                          const std::string& map_frame) {
  using visualization_msgs::Marker;
  visualization_msgs::MarkerArray markers;
  std::map<std::int64_t, geometry_msgs::Point> places;
  for (const SequencePath& path : paths) {
    Marker steps = line("steps", static_cast<int>(path.sequence), Marker::LINE_STRIP, map_frame);
    steps.color.g = 0.7F;
    steps.color.b = path.in_map ? 0.3F : 1.0F;
    for (const KeyframeVertex& keyframe : path.keyframes) {
      steps.points.push_back(vins_msgs::toMsg(keyframe.T_mb).position);
      places[keyframe.id] = steps.points.back();
    }
    if (steps.points.size() > 1) markers.markers.push_back(steps);
  }
  Marker ties = line("loops", 0, Marker::LINE_LIST, map_frame);
  ties.scale.x = 0.04;  // their ends are often near each other: wider than the paths
  ties.color.r = 1.0F;
  ties.color.g = 0.5F;
  for (const LoopEdge& loop : loops) {
    ties.points.push_back(places[loop.old_id]);
    ties.points.push_back(places[loop.query_id]);
  }
  if (!ties.points.empty()) markers.markers.push_back(ties);
  return markers;
}

}  // namespace vins::pose_graph
