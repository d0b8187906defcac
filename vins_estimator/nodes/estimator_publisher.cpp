#include "estimator_publisher.h"

#include <boost/make_shared.hpp>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <std_msgs/Float64.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include "vins_msgs/Event.h"
#include "vins_msgs/ImuBias.h"
#include "vins_msgs/Keyframe.h"
#include "vins_msgs/KeyframePoseUpdate.h"
#include "vins_msgs/LoopEdge.h"
#include "vins_msgs/odometry.h"

namespace vins::estimator {
namespace {

using vins_msgs::toTransform;

constexpr std::size_t kMaxPathPoses = 20000;  // 16 minutes at 20 Hz
constexpr std::size_t kMaxHistoryPoints = 100000;

}  // namespace

EstimatorPublisher::EstimatorPublisher(ros::NodeHandle node)
    : frames_(vins_msgs::readFrameNames(node)),
      publishes_tf_(vins_msgs::readSwitch(node, "publish_tf", true)),
      tf_at_imu_rate_(vins_msgs::readSwitch(node, "tf_at_imu_rate", false)),
      base_(frames_) {
  odometry_ = node.advertise<nav_msgs::Odometry>("odometry", 100);
  pose_ = node.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 100);
  propagated_ = node.advertise<nav_msgs::Odometry>("imu_propagate", 1000);
  path_topic_ = node.advertise<nav_msgs::Path>("path", 10);
  cloud_ = node.advertise<sensor_msgs::PointCloud2>("point_cloud", 10);
  history_topic_ = node.advertise<sensor_msgs::PointCloud2>("history_cloud", 10);
  key_poses_ = node.advertise<visualization_msgs::Marker>("key_poses", 10);
  camera_ = node.advertise<nav_msgs::Odometry>("camera_pose", 100);
  camera_visual_ = node.advertise<visualization_msgs::MarkerArray>("camera_pose_visual", 10);
  keyframe_ = node.advertise<vins_msgs::Keyframe>("keyframe", 100);
  left_ = node.advertise<vins_msgs::KeyframePoseUpdate>("keyframe_pose_update", 100);
  loop_edge_ = node.advertise<vins_msgs::LoopEdge>("loop_edge", 100);
  extrinsic_ = node.advertise<nav_msgs::Odometry>("extrinsic", 10);
  time_offset_ = node.advertise<std_msgs::Float64>("time_offset", 10);
  bias_ = node.advertise<vins_msgs::ImuBias>("imu_bias", 10);
  events_ = node.advertise<vins_msgs::Event>("event", 100);
  path_.header.frame_id = frames_.odom;
}

void EstimatorPublisher::clear() {
  path_.poses.clear();
  history_ = {};
}

void EstimatorPublisher::publish(const std::vector<Event>& events) {
  for (const Event& event : events) events_.publish(vins_msgs::toMsg(event));
}

void EstimatorPublisher::publish(const EstimatorResult& result) {
  if (!result.odometry) return;
  publishKeyframes(result);  // first: the pose graph learns from them what sequence this is
  publishOdometry(*result.odometry);
  publishCamera(result);
  publishRig(result);
  publishBias(*result.odometry);
  publishCameraTransform(result);
  publishWindow(result);
  publishClouds(result);
  publishLoopEdges(result);
}

void EstimatorPublisher::publish(const PropagatedState& state) {
  const std::optional<nav_msgs::Odometry> message = base_.toBase(toOdometry(state, frames_));
  if (!message) return;
  propagated_.publish(*message);
  if (publishes_tf_ && tf_at_imu_rate_) transforms_.sendTransform(toTransform(*message));
}

void EstimatorPublisher::publishOdometry(const Odometry& odometry) {
  const std::optional<nav_msgs::Odometry> message = base_.toBase(toOdometry(odometry, frames_));
  if (!message) return;
  odometry_.publish(boost::make_shared<nav_msgs::Odometry>(*message));
  publishPose(*message);
  addToPath(*message);
  if (publishes_tf_ && !tf_at_imu_rate_) transforms_.sendTransform(toTransform(*message));
}

void EstimatorPublisher::publishPose(const nav_msgs::Odometry& odometry) {
  if (pose_.getNumSubscribers() == 0) return;
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header = odometry.header;
  pose.pose = odometry.pose;
  pose_.publish(pose);
}

void EstimatorPublisher::addToPath(const nav_msgs::Odometry& odometry) {
  geometry_msgs::PoseStamped pose;
  pose.header = odometry.header;
  pose.pose = odometry.pose.pose;
  path_.header.stamp = odometry.header.stamp;
  path_.poses.push_back(pose);
  // Half goes at once, so that the cost is small on average.
  if (path_.poses.size() > kMaxPathPoses) {
    path_.poses.erase(path_.poses.begin(), path_.poses.begin() + kMaxPathPoses / 2);
  }
  if (path_topic_.getNumSubscribers() > 0) path_topic_.publish(path_);
}

void EstimatorPublisher::publishCamera(const EstimatorResult& result) {
  if (camera_.getNumSubscribers() + camera_visual_.getNumSubscribers() == 0) return;
  const nav_msgs::Odometry camera = vins_msgs::ofChildFrame(toOdometry(*result.odometry, frames_),
                                                            frames_.camera, result.rig.T_bc);
  camera_.publish(camera);
  if (camera_visual_.getNumSubscribers() == 0) return;
  visualization_msgs::MarkerArray frustum;
  frustum.markers.push_back(cameraFrustum(0.4));
  frustum.markers.front().header = camera.header;
  frustum.markers.front().pose = camera.pose.pose;
  camera_visual_.publish(frustum);
}

void EstimatorPublisher::publishRig(const EstimatorResult& result) {
  extrinsic_.publish(toExtrinsic(result.stamp, result.rig, result.rig_covariance, frames_));
  std_msgs::Float64 td;
  td.data = result.rig.td;
  time_offset_.publish(td);
}

void EstimatorPublisher::publishBias(const Odometry& odometry) {
  ImuBiasEstimate bias;
  bias.stamp = odometry.stamp;
  bias.accelerometer = odometry.state.accelerometer_bias;
  bias.gyroscope = odometry.state.gyroscope_bias;
  bias.accelerometer_covariance = odometry.covariance.block<3, 3>(kAccBias, kAccBias);
  bias.gyroscope_covariance = odometry.covariance.block<3, 3>(kGyrBias, kGyrBias);
  vins_msgs::ImuBias message = vins_msgs::toMsg(bias);
  message.header.frame_id = frames_.body;
  bias_.publish(message);
}

void EstimatorPublisher::publishCameraTransform(const EstimatorResult& result) {
  if (!publishes_tf_ || frames_.camera.empty()) return;
  transforms_.sendTransform(
      toTransform(toExtrinsic(result.stamp, result.rig, result.rig_covariance, frames_)));
}

void EstimatorPublisher::publishWindow(const EstimatorResult& result) {
  if (key_poses_.getNumSubscribers() == 0) return;
  visualization_msgs::Marker marker;
  marker.header.stamp = vins_msgs::toRosTime(result.stamp);
  marker.header.frame_id = frames_.odom;
  marker.ns = "key_poses";
  marker.type = visualization_msgs::Marker::SPHERE_LIST;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 0.05;
  marker.color.r = marker.color.a = 1.0F;
  for (const StampedNavState& state : result.window) {
    marker.points.push_back(vins_msgs::toMsg(state.state.T_wb).position);
  }
  key_poses_.publish(marker);
}

void EstimatorPublisher::publishClouds(const EstimatorResult& result) {
  std_msgs::Header header;
  header.stamp = vins_msgs::toRosTime(result.stamp);
  header.frame_id = frames_.odom;
  if (cloud_.getNumSubscribers() > 0) {
    sensor_msgs::PointCloud2 cloud = toCloud(result.landmarks);
    cloud.header = header;
    cloud_.publish(cloud);
  }
  if (!result.keyframes.empty()) addToHistory(result.keyframes.back(), header);
}

/// Accumulates without a subscriber, too: whoever comes later sees all that there was.
void EstimatorPublisher::addToHistory(const Keyframe& keyframe, const std_msgs::Header& header) {
  std::vector<LandmarkPoint> points;
  for (const KeyframePoint& point : keyframe.points) {
    points.push_back({point.id, point.position_w});
  }
  append(toCloud(points), kMaxHistoryPoints, &history_);
  history_.header = header;
  if (history_topic_.getNumSubscribers() > 0) history_topic_.publish(history_);
}

void EstimatorPublisher::publishKeyframes(const EstimatorResult& result) {
  for (const Keyframe& keyframe : result.keyframes) {
    // Shared, so that nodelets of one manager get it without a copy.
    const auto message = boost::make_shared<vins_msgs::Keyframe>(vins_msgs::toMsg(keyframe));
    message->header.frame_id = frames_.odom;
    keyframe_.publish(message);
  }
  for (const KeyframePoseUpdate& update : result.left) {
    const auto message =
        boost::make_shared<vins_msgs::KeyframePoseUpdate>(vins_msgs::toMsg(update));
    message->header.frame_id = frames_.odom;
    left_.publish(message);
  }
}

void EstimatorPublisher::publishLoopEdges(const EstimatorResult& result) {
  for (const LoopEdge& edge : result.loop_edges) {
    loop_edge_.publish(boost::make_shared<vins_msgs::LoopEdge>(vins_msgs::toMsg(edge)));
  }
}

}  // namespace vins::estimator
