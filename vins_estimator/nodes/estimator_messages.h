#pragma once

#include <vector>

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include "vins_core/pose.h"
#include "vins_estimator/estimator.h"
#include "vins_estimator/inertial/propagator.h"
#include "vins_msgs/frame_names.h"

namespace vins::estimator {

/// A state as nav_msgs/Odometry: the pose in `odom`, with a covariance about the fixed axes of
/// `odom`; the twist in `body`, with a covariance along the axes of `body`, as ROS defines them.
nav_msgs::Odometry toOdometry(const Odometry& odometry, const vins_msgs::FrameNames& frames);
nav_msgs::Odometry toOdometry(const PropagatedState& state, const vins_msgs::FrameNames& frames);

/// The camera's pose in `body`, with a covariance about the fixed axes of `body`. `covariance` is
/// of the rig's errors.
nav_msgs::Odometry toExtrinsic(Stamp stamp, const RigCalibration& rig, const RigMatrix& covariance,
                               const vins_msgs::FrameNames& frames);

/// x, y, z clouds in single precision.
sensor_msgs::PointCloud2 toCloud(const std::vector<LandmarkPoint>& points);

/// Appends `more` (of the same layout) to a cloud, dropping its oldest points beyond `max_points`.
void append(const sensor_msgs::PointCloud2& more, std::size_t max_points,
            sensor_msgs::PointCloud2* cloud);

/// A camera's frustum in its own frame: eight edges, `size` [m] across.
visualization_msgs::Marker cameraFrustum(double size);

}  // namespace vins::estimator
