#include "base_frame.h"

#include <tf2/exceptions.h>

#include "vins_msgs/odometry.h"

namespace vins::estimator {

BaseFrame::BaseFrame(const vins_msgs::FrameNames& names) : names_(names) {
  if (names_.hasBase()) listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
}

std::optional<nav_msgs::Odometry> BaseFrame::toBase(const nav_msgs::Odometry& of_body) {
  if (!names_.hasBase()) return of_body;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!T_body_base_) T_body_base_ = lookUp();
  if (!T_body_base_) return std::nullopt;
  return vins_msgs::ofChildFrame(of_body, names_.base, *T_body_base_);
}

std::optional<Pose> BaseFrame::lookUp() {
  try {
    const geometry_msgs::Transform T =
        buffer_.lookupTransform(names_.body, names_.base, ros::Time(0)).transform;
    const Eigen::Quaterniond R(T.rotation.w, T.rotation.x, T.rotation.y, T.rotation.z);
    listener_.reset();
    return Pose(R.normalized(), vins_msgs::fromMsg(T.translation));
  } catch (const tf2::TransformException& error) {
    ROS_WARN_STREAM_THROTTLE(5.0, "no odometry is published before tf has the pose of base_frame "
                                      << names_.base << " in body_frame " << names_.body << ": "
                                      << error.what());
    return std::nullopt;
  }
}

}  // namespace vins::estimator
