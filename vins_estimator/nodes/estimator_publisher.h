#pragma once

#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <tf2_ros/transform_broadcaster.h>

#include "base_frame.h"
#include "estimator_messages.h"

namespace vins::estimator {

/// Turns the estimator's results into messages. Topics live in the node's own namespace, under the
/// names that VINS-Mono's users know.
class EstimatorPublisher {
 public:
  /// Reads the frames' names (FrameNames) and the switches `publish_tf` (1) and `tf_at_imu_rate`
  /// (0) from the node's parameters. Throws InputError for values that are not allowed.
  explicit EstimatorPublisher(ros::NodeHandle node);

  /// All that one frame has brought.
  void publish(const EstimatorResult& result);

  /// Events, those of a frame or of the inputs alone.
  void publish(const std::vector<Event>& events);

  /// The state at an IMU sample.
  void publish(const PropagatedState& state);

  /// The paths and clouds begin anew.
  void clear();

 private:
  void publishOdometry(const Odometry& odometry);
  void publishPose(const nav_msgs::Odometry& odometry);
  void addToPath(const nav_msgs::Odometry& odometry);
  void publishCamera(const EstimatorResult& result);
  void publishRig(const EstimatorResult& result);
  void publishBias(const Odometry& odometry);
  void publishCameraTransform(const EstimatorResult& result);
  void publishWindow(const EstimatorResult& result);
  void publishClouds(const EstimatorResult& result);
  void addToHistory(const Keyframe& keyframe, const std_msgs::Header& header);
  void publishKeyframes(const EstimatorResult& result);
  void publishLoopEdges(const EstimatorResult& result);

  vins_msgs::FrameNames frames_;
  bool publishes_tf_;
  bool tf_at_imu_rate_;
  BaseFrame base_;
  nav_msgs::Path path_;
  sensor_msgs::PointCloud2 history_;
  ros::Publisher odometry_, pose_, propagated_, path_topic_, cloud_, history_topic_, key_poses_,
      camera_, camera_visual_, keyframe_, left_, loop_edge_, extrinsic_, time_offset_, bias_,
      events_;
  tf2_ros::TransformBroadcaster transforms_;
};

}  // namespace vins::estimator
