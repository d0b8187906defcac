#include "estimator_messages.h"

#include <cstring>

#include <sensor_msgs/point_cloud2_iterator.h>

#include "vins_estimator/inertial/body_twist.h"
#include "vins_msgs/odometry.h"

namespace vins::estimator {
namespace {

constexpr std::size_t kPointBytes = 3 * sizeof(float);

geometry_msgs::Point toPoint(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

/// Of an Odometry or a PropagatedState, which have the same parts.
template <typename State>
nav_msgs::Odometry toOdometry(Stamp stamp, const State& state,
                              const vins_msgs::FrameNames& frames) {
  const BodyTwist twist = bodyTwist(state.state, state.covariance, state.angular_velocity_b,
                                    state.angular_velocity_variance);
  nav_msgs::Odometry message;
  message.header.stamp = vins_msgs::toRosTime(stamp);
  message.header.frame_id = frames.odom;
  message.child_frame_id = frames.body;
  message.pose = vins_msgs::toMsg(state.state.T_wb,
                                  se3::Matrix6d(state.covariance.template topLeftCorner<6, 6>()));
  message.twist = vins_msgs::toMsg(twist.linear_b, twist.angular_b, twist.covariance);
  return message;
}

}  // namespace

nav_msgs::Odometry toOdometry(const Odometry& odometry, const vins_msgs::FrameNames& frames) {
  return toOdometry(odometry.stamp, odometry, frames);
}

nav_msgs::Odometry toOdometry(const PropagatedState& state, const vins_msgs::FrameNames& frames) {
  return toOdometry(state.stamp, state, frames);
}

nav_msgs::Odometry toExtrinsic(Stamp stamp, const RigCalibration& rig, const RigMatrix& covariance,
                               const vins_msgs::FrameNames& frames) {
  nav_msgs::Odometry message;
  message.header.stamp = vins_msgs::toRosTime(stamp);
  message.header.frame_id = frames.body;
  message.child_frame_id = frames.camera;
  message.pose = vins_msgs::toMsg(rig.T_bc, se3::Matrix6d(covariance.topLeftCorner<6, 6>()));
  return message;
}

sensor_msgs::PointCloud2 toCloud(const std::vector<LandmarkPoint>& points) {
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(3, "x", 1, sensor_msgs::PointField::FLOAT32, "y", 1,
                                sensor_msgs::PointField::FLOAT32, "z", 1,
                                sensor_msgs::PointField::FLOAT32);
  modifier.resize(points.size());
  sensor_msgs::PointCloud2Iterator<float> it(cloud, "x");
  for (const LandmarkPoint& point : points) {
    for (int axis = 0; axis < 3; ++axis) it[axis] = static_cast<float>(point.position_w[axis]);
    ++it;
  }
  return cloud;
}

void append(const sensor_msgs::PointCloud2& more, std::size_t max_points,
            sensor_msgs::PointCloud2* cloud) {
  if (cloud->data.empty())
    *cloud = more;
  else
    cloud->data.insert(cloud->data.end(), more.data.begin(), more.data.end());
  const std::size_t max_bytes = max_points * kPointBytes;
  if (cloud->data.size() > max_bytes) {
    cloud->data.erase(cloud->data.begin(),
                      cloud->data.end() - static_cast<std::ptrdiff_t>(max_bytes));
  }
  cloud->width = static_cast<std::uint32_t>(cloud->data.size() / kPointBytes);
  cloud->row_step = static_cast<std::uint32_t>(cloud->data.size());
}

visualization_msgs::Marker cameraFrustum(double size) {
  visualization_msgs::Marker marker;
  marker.ns = "camera";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.05 * size;
  marker.color.r = 1.0F;
  marker.color.g = 0.3F;
  marker.color.a = 1.0F;
  const double w = 0.5 * size, h = 0.32 * size, d = 0.4 * size;
  const geometry_msgs::Point corners[] = {toPoint(-w, -h, d), toPoint(w, -h, d), toPoint(w, h, d),
                                          toPoint(-w, h, d)};
  for (int i = 0; i < 4; ++i) {
    marker.points.push_back(toPoint(0.0, 0.0, 0.0));
    marker.points.push_back(corners[i]);
    marker.points.push_back(corners[i]);
    marker.points.push_back(corners[(i + 1) % 4]);
  }
  return marker;
}

}  // namespace vins::estimator
