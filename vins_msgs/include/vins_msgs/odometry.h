#pragma once

#include <string>

#include <Eigen/Core>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>

#include "vins_core/pose.h"
#include "vins_core/pose_covariance.h"
#include "vins_core/so3.h"
#include "vins_msgs/conversions.h"

/// nav_msgs/Odometry as ROS defines it: the pose of child_frame_id in frame_id, with a covariance
/// of position and rotation about the fixed axes of frame_id; the twist along the axes of
/// child_frame_id, with a covariance along these (REP 105, geometry_msgs/PoseWithCovariance). The
/// conversions between this and the estimator's conventions (vins_core/pose_covariance.h) are here
/// and nowhere else.
namespace vins_msgs {

/// The covariance of a message's pose or twist.
template <typename WithCovariance>
vins::se3::Matrix6d covarianceOf(const WithCovariance& message) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance.data());
}

inline Eigen::Vector3d fromMsg(const geometry_msgs::Vector3& message) {
  return {message.x, message.y, message.z};
}

/// Pose and covariance of T_ab, whose covariance is about body axes.
inline geometry_msgs::PoseWithCovariance toMsg(const vins::Pose& T_ab,
                                               const vins::se3::Matrix6d& covariance) {
  geometry_msgs::PoseWithCovariance message;
  message.pose = toMsg(T_ab);
  copyTo(vins::aboutFixedAxes(T_ab.rotation, covariance), message.covariance);
  return message;
}

/// A twist along the axes of its own frame, linear [m/s] first, then angular [rad/s].
inline geometry_msgs::TwistWithCovariance toMsg(const Eigen::Vector3d& linear,
                                                const Eigen::Vector3d& angular,
                                                const vins::se3::Matrix6d& covariance) {
  geometry_msgs::TwistWithCovariance message;
  message.twist.linear = toMsg(linear);
  message.twist.angular = toMsg(angular);
  copyTo(covariance, message.covariance);
  return message;
}

/// The pose of a message as tf has it: frame_id -> child_frame_id.
inline geometry_msgs::TransformStamped toTransform(const nav_msgs::Odometry& odometry) {
  geometry_msgs::TransformStamped message;
  message.header = odometry.header;
  message.child_frame_id = odometry.child_frame_id;
  message.transform.translation.x = odometry.pose.pose.position.x;
  message.transform.translation.y = odometry.pose.pose.position.y;
  message.transform.translation.z = odometry.pose.pose.position.z;
  message.transform.rotation = odometry.pose.pose.orientation;
  return message;
}

/// The same pose in another parent frame: T_pf takes the message's frame_id to `parent`, with a
/// covariance about the fixed axes of `parent`, independent of the odometry's. Throws InputError as
/// FieldReader::pose() does.
inline nav_msgs::Odometry inParentFrame(nav_msgs::Odometry odometry, const std::string& parent,
                                        const vins::Pose& T_pf,
                                        const vins::se3::Matrix6d& covariance) {
  const vins::Pose T_fc = fromMsg(odometry.pose.pose);
  odometry.header.frame_id = parent;
  copyTo(vins::covarianceOfProduct(T_pf, covariance, T_fc, covarianceOf(odometry.pose)),
         odometry.pose.covariance);
  odometry.pose.pose = toMsg(T_pf * T_fc);
  return odometry;
}

/// The same motion, told of another frame that is fixed to the same rigid body: T_cd is the pose of
/// `child` in the message's child frame, taken as exact. Throws InputError as FieldReader::pose()
/// does.
inline nav_msgs::Odometry ofChildFrame(nav_msgs::Odometry odometry, const std::string& child,
                                       const vins::Pose& T_cd) {
  using vins::se3::Matrix6d;
  const vins::Pose T_fc = fromMsg(odometry.pose.pose);
  const Eigen::Matrix3d R_dc = T_cd.rotation.conjugate().toRotationMatrix();
  // v_d = R_dc (v_c + w_c x p_cd).
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = R_dc;
  J.topRightCorner<3, 3>() = -R_dc * vins::so3::hat(T_cd.position);
  vins::se3::Vector6d twist;
  twist << fromMsg(odometry.twist.twist.linear), fromMsg(odometry.twist.twist.angular);
  twist = J * twist;
  odometry.twist =
      toMsg(twist.head<3>(), twist.tail<3>(), J * covarianceOf(odometry.twist) * J.transpose());
  copyTo(vins::covarianceOfProduct(T_fc, covarianceOf(odometry.pose), T_cd, Matrix6d::Zero()),
         odometry.pose.covariance);
  odometry.pose.pose = toMsg(T_fc * T_cd);
  odometry.child_frame_id = child;
  return odometry;
}

}  // namespace vins_msgs
