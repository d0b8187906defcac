#pragma once

#include <string>
#include <vector>

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include "vins_core/pose.h"
#include "vins_estimator/estimator.h"

namespace vins::estimator {

/// A state as nav_msgs/Odometry: the pose in `odom`, the twist in `body`, as the message wants it.
/// Its covariances are of position (world axes) and rotation (body axes), of velocity (body axes).
nav_msgs::Odometry toOdometry(Stamp stamp, const NavState& state,
                              const Eigen::Vector3d& angular_velocity_b,
                              const Matrix15d& covariance, double gyroscope_noise,
                              const std::string& odom, const std::string& body);

/// x, y, z clouds in single precision.
sensor_msgs::PointCloud2 toCloud(const std::vector<LandmarkPoint>& points);

/// Appends `more` (of the same layout) to a cloud, dropping its oldest points beyond `max_points`.
void append(const sensor_msgs::PointCloud2& more, std::size_t max_points,
            sensor_msgs::PointCloud2* cloud);

/// A camera's frustum in its own frame: eight edges, `size` [m] across.
visualization_msgs::Marker cameraFrustum(double size);

}  // namespace vins::estimator
