#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include <nav_msgs/Odometry.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "vins_core/pose.h"
#include "vins_msgs/frame_names.h"

namespace vins::estimator {

/// The robot's frame, where it is another than the body: its pose in the body comes by tf, from a
/// URDF's publisher or a static one, and is taken once. Safe to be used by several threads.
class BaseFrame {
 public:
  explicit BaseFrame(const vins_msgs::FrameNames& names);

  /// The body's odometry, told of the base; nullopt while tf does not have its pose.
  std::optional<nav_msgs::Odometry> toBase(const nav_msgs::Odometry& of_body);

 private:
  std::optional<Pose> lookUp();

  vins_msgs::FrameNames names_;
  std::mutex mutex_;
  std::optional<Pose> T_body_base_;
  tf2_ros::Buffer buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;  ///< until the pose is known
};

}  // namespace vins::estimator
