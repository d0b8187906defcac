#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <Eigen/Core>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/input_error.h"
#include "vins_core/keyframe.h"
#include "vins_core/loop_match.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"
#include "vins_msgs/Event.h"
#include "vins_msgs/FeatureFrame.h"
#include "vins_msgs/ImuBias.h"
#include "vins_msgs/Keyframe.h"
#include "vins_msgs/KeyframePoseUpdate.h"
#include "vins_msgs/LoopEdge.h"
#include "vins_msgs/LoopMatch.h"
#include "vins_msgs/field_reader.h"

/// Converts between the types of vins_core and ROS messages, exactly: what goes through a message
/// comes out with the same bits. toMsg() leaves header.frame_id to the caller. fromMsg() throws
/// vins::InputError naming message, stamp and field where a message is malformed (see FieldReader).
namespace vins_msgs {

/// Exact; throws vins::InputError where ros::Time, of 32 bit seconds from 0 on, cannot hold it.
inline ros::Time toRosTime(vins::Stamp stamp) {
  constexpr vins::Stamp kSecond = 1'000'000'000;
  constexpr vins::Stamp kLast = std::numeric_limits<std::uint32_t>::max() * kSecond + kSecond - 1;
  if (stamp < 0 || stamp > kLast) {
    throw vins::InputError("stamp " + std::to_string(stamp) + " ns; allowed in ROS: 0 to " +
                           std::to_string(kLast) + " ns");
  }
  return {static_cast<std::uint32_t>(stamp / kSecond), static_cast<std::uint32_t>(stamp % kSecond)};
}

/// Exact, of every ros::Time.
inline vins::Stamp toStamp(const ros::Time& time) {
  return vins::Stamp{time.sec} * 1'000'000'000 + time.nsec;
}

/// Copies a vector, or a matrix row by row, into a float64[] field.
template <typename Derived, typename Array>
void copyTo(const Eigen::MatrixBase<Derived>& values, Array& field) {
  static_assert(sizeof(Array) == Derived::SizeAtCompileTime * sizeof(double), "another length");
  constexpr int kRows = Derived::RowsAtCompileTime;
  constexpr int kColumns = Derived::ColsAtCompileTime;
  constexpr int kOrder = kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor;
  Eigen::Map<Eigen::Matrix<double, kRows, kColumns, kOrder>>(field.data()) = values;
}

// Vectors and poses.

inline geometry_msgs::Vector3 toMsg(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

inline geometry_msgs::Pose toMsg(const vins::Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.position.x();
  message.position.y = pose.position.y();
  message.position.z = pose.position.z();
  message.orientation.w = pose.rotation.w();
  message.orientation.x = pose.rotation.x();
  message.orientation.y = pose.rotation.y();
  message.orientation.z = pose.rotation.z();
  return message;
}

inline vins::Pose fromMsg(const geometry_msgs::Pose& message) {
  return FieldReader(message).pose(message);
}

// IMU.

/// The orientation is marked as not measured (sensor_msgs/Imu: covariance -1).
inline sensor_msgs::Imu toMsg(const vins::ImuSample& sample) {
  sensor_msgs::Imu message;
  message.header.stamp = toRosTime(sample.stamp);
  message.orientation.w = 1.0;
  message.orientation_covariance[0] = -1.0;
  message.linear_acceleration = toMsg(sample.acceleration);
  message.angular_velocity = toMsg(sample.angular_velocity);
  return message;
}

/// Never throws: a sample with NaN is handed on as it is, for the estimator's queue drops, counts
/// and reports it, and one bad sample must not cost a callback.
inline vins::ImuSample fromMsg(const sensor_msgs::Imu& message) {
  const geometry_msgs::Vector3& a = message.linear_acceleration;
  const geometry_msgs::Vector3& w = message.angular_velocity;
  return {toStamp(message.header.stamp), {a.x, a.y, a.z}, {w.x, w.y, w.z}};
}

inline ImuBias toMsg(const vins::ImuBiasEstimate& bias) {
  ImuBias message;
  message.header.stamp = toRosTime(bias.stamp);
  message.accelerometer = toMsg(bias.accelerometer);
  message.gyroscope = toMsg(bias.gyroscope);
  copyTo(bias.accelerometer_covariance, message.accelerometer_covariance);
  copyTo(bias.gyroscope_covariance, message.gyroscope_covariance);
  return message;
}

inline vins::ImuBiasEstimate fromMsg(const ImuBias& message) {
  const FieldReader reader(message);
  vins::ImuBiasEstimate bias;
  bias.stamp = toStamp(message.header.stamp);
  bias.accelerometer = reader.vector("accelerometer", message.accelerometer);
  bias.gyroscope = reader.vector("gyroscope", message.gyroscope);
  bias.accelerometer_covariance =
      reader.covariance<3>("accelerometer_covariance", message.accelerometer_covariance);
  bias.gyroscope_covariance =
      reader.covariance<3>("gyroscope_covariance", message.gyroscope_covariance);
  return bias;
}

// Features.

inline FeatureObservation toMsg(const vins::FeatureObservation& observation) {
  FeatureObservation message;
  message.id = observation.id;
  message.camera = observation.camera;
  message.track_length = observation.track_length;
  copyTo(observation.pixel, message.pixel);
  copyTo(observation.bearing, message.bearing);
  copyTo(observation.bearing_velocity, message.bearing_velocity);
  message.angular_resolution = observation.angular_resolution;
  return message;
}

/// `reader` says where the element stands: FieldReader(message) for one on its own.
inline vins::FeatureObservation fromMsg(const FeatureObservation& message,
                                        const FieldReader& reader) {
  constexpr int kAny = std::numeric_limits<int>::max();
  vins::FeatureObservation observation;
  observation.id = message.id;
  observation.camera = reader.integer("camera", message.camera, 0, 1);
  observation.track_length = reader.integer("track_length", message.track_length, 1, kAny);
  observation.pixel = reader.vector<2>("pixel", message.pixel);
  observation.bearing = reader.bearing("bearing", message.bearing);
  observation.bearing_velocity = reader.vector<3>("bearing_velocity", message.bearing_velocity);
  observation.angular_resolution =
      reader.positive("angular_resolution", message.angular_resolution);
  return observation;
}

inline FeatureFrame toMsg(const vins::FeatureFrame& frame) {
  FeatureFrame message;
  message.header.stamp = toRosTime(frame.stamp);
  message.sequence = frame.sequence;
  message.observations.reserve(frame.observations.size());
  for (const auto& observation : frame.observations) {
    message.observations.push_back(toMsg(observation));
  }
  return message;
}

inline vins::FeatureFrame fromMsg(const FeatureFrame& message) {
  const FieldReader reader(message);
  vins::FeatureFrame frame;
  frame.stamp = toStamp(message.header.stamp);
  frame.sequence = message.sequence;
  frame.observations.reserve(message.observations.size());
  for (std::size_t i = 0; i < message.observations.size(); ++i) {
    frame.observations.push_back(
        fromMsg(message.observations[i], reader.inside("observations", i)));
  }
  return frame;
}

// Keyframes.

inline KeyframePoint toMsg(const vins::KeyframePoint& point) {
  KeyframePoint message;
  message.id = point.id;
  copyTo(point.pixel, message.pixel);
  copyTo(point.bearing, message.bearing);
  copyTo(point.position_w, message.position_w);
  return message;
}

/// `reader` says where the element stands: FieldReader(message) for one on its own.
inline vins::KeyframePoint fromMsg(const KeyframePoint& message, const FieldReader& reader) {
  vins::KeyframePoint point;
  point.id = message.id;
  point.pixel = reader.vector<2>("pixel", message.pixel);
  point.bearing = reader.bearing("bearing", message.bearing);
  point.position_w = reader.vector<3>("position_w", message.position_w);
  return point;
}

inline Keyframe toMsg(const vins::Keyframe& keyframe) {
  Keyframe message;
  message.header.stamp = toRosTime(keyframe.stamp);
  message.id = keyframe.id;
  message.sequence = keyframe.sequence;
  message.T_wb = toMsg(keyframe.T_wb);
  message.T_bc = toMsg(keyframe.T_bc);
  message.chosen_at = toRosTime(keyframe.chosen_at);
  copyTo(keyframe.covariance, message.covariance);
  message.points.reserve(keyframe.points.size());
  for (const auto& point : keyframe.points) message.points.push_back(toMsg(point));
  message.world = keyframe.world;
  return message;
}

inline vins::Keyframe fromMsg(const Keyframe& message) {
  const FieldReader reader(message);
  vins::Keyframe keyframe;
  keyframe.stamp = toStamp(message.header.stamp);
  keyframe.id = message.id;
  keyframe.sequence = message.sequence;
  keyframe.T_wb = reader.inside("T_wb").pose(message.T_wb);
  keyframe.T_bc = reader.inside("T_bc").pose(message.T_bc);
  keyframe.chosen_at = toStamp(message.chosen_at);
  keyframe.covariance = reader.covariance<6>("covariance", message.covariance);
  keyframe.points.reserve(message.points.size());
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    keyframe.points.push_back(fromMsg(message.points[i], reader.inside("points", i)));
  }
  keyframe.world = message.world;
  return keyframe;
}

inline KeyframePoseUpdate toMsg(const vins::KeyframePoseUpdate& update) {
  KeyframePoseUpdate message;
  message.header.stamp = toRosTime(update.stamp);
  message.keyframe_id = update.keyframe_id;
  message.sequence = update.sequence;
  message.T_wb = toMsg(update.T_wb);
  return message;
}

inline vins::KeyframePoseUpdate fromMsg(const KeyframePoseUpdate& message) {
  vins::KeyframePoseUpdate update;
  update.stamp = toStamp(message.header.stamp);
  update.keyframe_id = message.keyframe_id;
  update.sequence = message.sequence;
  update.T_wb = FieldReader(message).inside("T_wb").pose(message.T_wb);
  return update;
}

// Loops.

inline MatchedFeature toMsg(const vins::MatchedFeature& feature) {
  MatchedFeature message;
  message.id = feature.id;
  copyTo(feature.bearing_old, message.bearing_old);
  return message;
}

/// `reader` says where the element stands: FieldReader(message) for one on its own.
inline vins::MatchedFeature fromMsg(const MatchedFeature& message, const FieldReader& reader) {
  return {message.id, reader.bearing("bearing_old", message.bearing_old)};
}

inline LoopMatch toMsg(const vins::LoopMatch& match) {
  LoopMatch message;
  message.header.stamp = toRosTime(match.query_stamp);
  message.query_id = match.query_id;
  message.old_id = match.old_id;
  message.T_wb_old = toMsg(match.T_wb_old);
  message.T_bc_old = toMsg(match.T_bc_old);
  message.T_old_query = toMsg(match.T_old_query);
  message.features.reserve(match.features.size());
  for (const auto& feature : match.features) message.features.push_back(toMsg(feature));
  return message;
}

inline vins::LoopMatch fromMsg(const LoopMatch& message) {
  const FieldReader reader(message);
  vins::LoopMatch match;
  match.query_stamp = toStamp(message.header.stamp);
  match.query_id = message.query_id;
  match.old_id = message.old_id;
  match.T_wb_old = reader.inside("T_wb_old").pose(message.T_wb_old);
  match.T_bc_old = reader.inside("T_bc_old").pose(message.T_bc_old);
  match.T_old_query = reader.inside("T_old_query").pose(message.T_old_query);
  match.features.reserve(message.features.size());
  for (std::size_t i = 0; i < message.features.size(); ++i) {
    match.features.push_back(fromMsg(message.features[i], reader.inside("features", i)));
  }
  return match;
}

inline LoopEdge toMsg(const vins::LoopEdge& edge) {
  LoopEdge message;
  message.header.stamp = toRosTime(edge.query_stamp);
  message.query_id = edge.query_id;
  message.old_id = edge.old_id;
  message.T_old_query = toMsg(edge.T_old_query);
  copyTo(edge.covariance, message.covariance);
  message.inliers = edge.inliers;
  return message;
}

inline vins::LoopEdge fromMsg(const LoopEdge& message) {
  constexpr int kAny = std::numeric_limits<int>::max();
  const FieldReader reader(message);
  vins::LoopEdge edge;
  edge.query_stamp = toStamp(message.header.stamp);
  edge.query_id = message.query_id;
  edge.old_id = message.old_id;
  edge.T_old_query = reader.inside("T_old_query").pose(message.T_old_query);
  edge.covariance = reader.covariance<6>("covariance", message.covariance);
  edge.inliers = reader.integer("inliers", message.inliers, 0, kAny);
  return edge;
}

// Events.

static_assert(Event::INFO == static_cast<int>(vins::Severity::kInfo), "same numbers");
static_assert(Event::WARNING == static_cast<int>(vins::Severity::kWarning), "same numbers");
static_assert(Event::ERROR == static_cast<int>(vins::Severity::kError), "same numbers");

inline Event toMsg(const vins::Event& event) {
  Event message;
  message.header.stamp = toRosTime(event.stamp);
  message.severity = static_cast<std::uint8_t>(event.severity);
  message.code = event.code;
  message.text = event.text;
  for (const auto& [name, value] : event.figures) {
    message.figure_names.push_back(name);
    message.figure_values.push_back(value);
  }
  return message;
}

/// Figures may be NaN or infinite: an event may be about just that.
inline vins::Event fromMsg(const Event& message) {
  const FieldReader reader(message);
  const std::size_t names = message.figure_names.size();
  if (message.figure_values.size() != names) {
    reader.refuse("figure_values",
                  "has " + std::to_string(message.figure_values.size()) + " elements",
                  "as many as figure_names, " + std::to_string(names));
  }
  vins::Event event;
  event.stamp = toStamp(message.header.stamp);
  event.severity =
      static_cast<vins::Severity>(reader.integer("severity", message.severity, 0, Event::ERROR));
  event.code = message.code;
  event.text = message.text;
  for (std::size_t i = 0; i < names; ++i) {
    event.figures.emplace_back(message.figure_names[i], message.figure_values[i]);
  }
  return event;
}

}  // namespace vins_msgs
