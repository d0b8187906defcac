#include "pose_graph_publisher.h"

#include <boost/make_shared.hpp>
#include <cv_bridge/cv_bridge.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

#include "pose_graph_messages.h"
#include "vins_msgs/Event.h"
#include "vins_msgs/LoopMatch.h"
#include "vins_msgs/odometry.h"

namespace vins::pose_graph {
namespace {

constexpr double kPathPeriod = 0.5;  // [s]

void append(const nav_msgs::Path& more, nav_msgs::Path* path) {
  path->header = more.header;
  path->poses.insert(path->poses.end(), more.poses.begin(), more.poses.end());
}

/// Sequences of loaded maps have negative numbers.
bool isOfThisRun(const SequencePath& path) { return path.sequence >= 0; }

}  // namespace

PoseGraphPublisher::PoseGraphPublisher(const ros::NodeHandle& node)
    : node_(node),
      frames_(vins_msgs::readFrameNames(node)),
      publishes_tf_(vins_msgs::readSwitch(node, "publish_tf", true)) {
  match_ = node_.advertise<vins_msgs::LoopMatch>("loop_match", 100);
  path_ = node_.advertise<nav_msgs::Path>("pose_graph_path", 10);
  no_loop_path_ = node_.advertise<nav_msgs::Path>("no_loop_path", 10);
  base_path_ = node_.advertise<nav_msgs::Path>("base_path", 10, true);
  markers_ = node_.advertise<visualization_msgs::MarkerArray>("pose_graph", 10);
  picture_ = node_.advertise<sensor_msgs::Image>("match_image", 10);
  odometry_ = node_.advertise<nav_msgs::Odometry>("odometry", 100);
  events_ = node_.advertise<vins_msgs::Event>("event", 100);
}

void PoseGraphPublisher::publish(const std::vector<Event>& events) {
  for (const Event& event : events) events_.publish(vins_msgs::toMsg(event));
}

void PoseGraphPublisher::publish(const LoopMatch& match) {
  // Shared, so that nodelets of one manager get it without a copy.
  const auto message = boost::make_shared<vins_msgs::LoopMatch>(vins_msgs::toMsg(match));
  message->header.frame_id = frames_.odom;
  match_.publish(message);
}

void PoseGraphPublisher::publish(const nav_msgs::Odometry& odometry,
                                 const MapFromOdom& map_from_odom) {
  if (publishes_tf_) {
    nav_msgs::Odometry map_from_odom_message;
    map_from_odom_message.header.stamp = odometry.header.stamp;
    map_from_odom_message.header.frame_id = frames_.map;
    map_from_odom_message.child_frame_id = frames_.odom;
    map_from_odom_message.pose.pose = vins_msgs::toMsg(map_from_odom.pose);
    transforms_.sendTransform(vins_msgs::toTransform(map_from_odom_message));
  }
  odometry_.publish(toMapOdometry(odometry, map_from_odom, frames_.map));
}

void PoseGraphPublisher::publishPaths(PoseGraph* graph, bool now) {
  const ros::WallTime time = ros::WallTime::now();
  if (!now && (time - last_paths_).toSec() < kPathPeriod) return;
  last_paths_ = time;
  const std::vector<SequencePath> paths = graph->paths();
  if (paths.empty()) return;
  publishMapPath(paths, now);
  publishSequences(paths);
  if (isOfThisRun(paths.back()) && no_loop_path_.getNumSubscribers() > 0) {
    no_loop_path_.publish(toOdometryPath(paths.back(), frames_.odom));
  }
  if (markers_.getNumSubscribers() > 0) {
    markers_.publish(toMarkers(paths, graph->loops(), frames_.map));
  }
}

void PoseGraphPublisher::publishMapPath(const std::vector<SequencePath>& paths, bool now) {
  if (!now && path_.getNumSubscribers() + base_path_.getNumSubscribers() == 0) return;
  nav_msgs::Path base, all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!paths[i].in_map) continue;
    const nav_msgs::Path path = toPath(paths[i], frames_.map);
    append(path, &all);
    if (i + 1 < paths.size() || !isOfThisRun(paths[i])) append(path, &base);
  }
  path_.publish(all);
  if (!base.poses.empty()) base_path_.publish(base);
}

void PoseGraphPublisher::publishSequences(const std::vector<SequencePath>& paths) {
  for (const SequencePath& path : paths) {
    ros::Publisher& publisher = sequences_[path.sequence];
    if (!publisher) {
      const std::string topic = "path_" + std::to_string(sequences_.size());
      publisher = node_.advertise<nav_msgs::Path>(topic, 10, true);
    }
    if (publisher.getNumSubscribers() > 0) publisher.publish(toPath(path, frames_.map));
  }
}

void PoseGraphPublisher::publishPicture(Stamp stamp, const cv::Mat& picture) {
  if (picture.empty()) return;
  std_msgs::Header header;
  header.stamp = vins_msgs::toRosTime(stamp);
  picture_.publish(cv_bridge::CvImage(header, "bgr8", picture).toImageMsg());
}

}  // namespace vins::pose_graph
