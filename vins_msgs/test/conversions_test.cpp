#include "vins_msgs/conversions.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include "test_values.h"

namespace vins_msgs {
namespace {

using Eigen::Vector3d;

// Exact equality of every field. A field added to a type breaks its line `const auto& [...]`: it
// belongs into the message, its conversions and here.

void expectSame(const vins::Pose& a, const vins::Pose& b) {
  const auto& [rotation, position] = a;
  EXPECT_EQ(rotation.coeffs(), b.rotation.coeffs());
  EXPECT_EQ(position, b.position);
}

void expectSame(const vins::ImuSample& a, const vins::ImuSample& b) {
  const auto& [stamp, acceleration, angular_velocity] = a;
  EXPECT_EQ(stamp, b.stamp);
  EXPECT_EQ(acceleration, b.acceleration);
  EXPECT_EQ(angular_velocity, b.angular_velocity);
}

void expectSame(const vins::ImuBiasEstimate& a, const vins::ImuBiasEstimate& b) {
  const auto& [stamp, accelerometer, gyroscope, accelerometer_cov, gyroscope_cov] = a;
  EXPECT_EQ(stamp, b.stamp);
  EXPECT_EQ(accelerometer, b.accelerometer);
  EXPECT_EQ(gyroscope, b.gyroscope);
  EXPECT_EQ(accelerometer_cov, b.accelerometer_covariance);
  EXPECT_EQ(gyroscope_cov, b.gyroscope_covariance);
}

void expectSame(const vins::FeatureObservation& a, const vins::FeatureObservation& b) {
  const auto& [id, camera, track_length, pixel, bearing, bearing_velocity, resolution] = a;
  EXPECT_EQ(id, b.id);
  EXPECT_EQ(camera, b.camera);
  EXPECT_EQ(track_length, b.track_length);
  EXPECT_EQ(pixel, b.pixel);
  EXPECT_EQ(bearing, b.bearing);
  EXPECT_EQ(bearing_velocity, b.bearing_velocity);
  EXPECT_EQ(resolution, b.angular_resolution);
}

void expectSame(const vins::KeyframePoint& a, const vins::KeyframePoint& b) {
  const auto& [id, pixel, bearing, position_w] = a;
  EXPECT_EQ(id, b.id);
  EXPECT_EQ(pixel, b.pixel);
  EXPECT_EQ(bearing, b.bearing);
  EXPECT_EQ(position_w, b.position_w);
}

void expectSame(const vins::MatchedFeature& a, const vins::MatchedFeature& b) {
  const auto& [id, bearing_old] = a;
  EXPECT_EQ(id, b.id);
  EXPECT_EQ(bearing_old, b.bearing_old);
}

template <typename Element>
void expectSame(const std::vector<Element>& a, const std::vector<Element>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expectSame(a[i], b[i]);
}

void expectSame(const vins::FeatureFrame& a, const vins::FeatureFrame& b) {
  const auto& [stamp, sequence, observations] = a;
  EXPECT_EQ(stamp, b.stamp);
  EXPECT_EQ(sequence, b.sequence);
  expectSame(observations, b.observations);
}

void expectSame(const vins::Keyframe& a, const vins::Keyframe& b) {
  const auto& [id, sequence, stamp, chosen_at, T_wb, T_bc, covariance, points, world] = a;
  EXPECT_EQ(id, b.id);
  EXPECT_EQ(sequence, b.sequence);
  EXPECT_EQ(stamp, b.stamp);
  EXPECT_EQ(chosen_at, b.chosen_at);
  expectSame(T_wb, b.T_wb);
  expectSame(T_bc, b.T_bc);
  EXPECT_EQ(covariance, b.covariance);
  expectSame(points, b.points);
  EXPECT_EQ(world, b.world);
}

void expectSame(const vins::KeyframePoseUpdate& a, const vins::KeyframePoseUpdate& b) {
  const auto& [keyframe_id, sequence, stamp, T_wb] = a;
  EXPECT_EQ(keyframe_id, b.keyframe_id);
  EXPECT_EQ(sequence, b.sequence);
  EXPECT_EQ(stamp, b.stamp);
  expectSame(T_wb, b.T_wb);
}

void expectSame(const vins::LoopMatch& a, const vins::LoopMatch& b) {
  const auto& [query_id, old_id, query_stamp, T_wb_old, T_bc_old, T_old_query, features] = a;
  EXPECT_EQ(query_id, b.query_id);
  EXPECT_EQ(old_id, b.old_id);
  EXPECT_EQ(query_stamp, b.query_stamp);
  expectSame(T_wb_old, b.T_wb_old);
  expectSame(T_bc_old, b.T_bc_old);
  expectSame(T_old_query, b.T_old_query);
  expectSame(features, b.features);
}

void expectSame(const vins::LoopEdge& a, const vins::LoopEdge& b) {
  const auto& [query_id, old_id, query_stamp, T_old_query, covariance, inliers] = a;
  EXPECT_EQ(query_id, b.query_id);
  EXPECT_EQ(old_id, b.old_id);
  EXPECT_EQ(query_stamp, b.query_stamp);
  expectSame(T_old_query, b.T_old_query);
  EXPECT_EQ(covariance, b.covariance);
  EXPECT_EQ(inliers, b.inliers);
}

void expectSame(const vins::Event& a, const vins::Event& b) {
  const auto& [stamp, severity, code, text, figures] = a;
  EXPECT_EQ(stamp, b.stamp);
  EXPECT_EQ(severity, b.severity);
  EXPECT_EQ(code, b.code);
  EXPECT_EQ(text, b.text);
  EXPECT_EQ(figures, b.figures);
}

/// What a subscriber in another process receives.
template <typename Message>
Message throughTheWire(const Message& message) {
  Message received;
  ros::serialization::deserializeMessage(ros::serialization::serializeMessage(message), received);
  return received;
}

template <typename Type>
void expectRoundTrip(const Type& value) {
  expectSame(value, fromMsg(toMsg(value)));
  expectSame(value, fromMsg(throughTheWire(toMsg(value))));
}

TEST(Conversions, EveryTypeComesBackExactly) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    expectRoundTrip(random.pose());
    expectRoundTrip(random.imuSample());
    expectRoundTrip(random.imuBias());
    expectRoundTrip(random.featureFrame());
    expectRoundTrip(random.keyframe());
    expectRoundTrip(random.poseUpdate());
    expectRoundTrip(random.loopMatch());
    expectRoundTrip(random.loopEdge());
    expectRoundTrip(random.event());
  }
}

TEST(Conversions, EmptyListsComeBackEmpty) {
  expectRoundTrip(vins::FeatureFrame{});
  expectRoundTrip(vins::Keyframe{});
  expectRoundTrip(vins::LoopMatch{});
  expectRoundTrip(vins::Event{});
}

TEST(Conversions, SingleElementsComeBackExactly) {
  Random random;
  const auto observation = random.observation();
  const FeatureObservation observation_message = toMsg(observation);
  expectSame(observation, fromMsg(observation_message, FieldReader(observation_message)));
  const auto point = random.keyframePoint();
  const KeyframePoint point_message = toMsg(point);
  expectSame(point, fromMsg(point_message, FieldReader(point_message)));
  const auto feature = random.matchedFeature();
  const MatchedFeature feature_message = toMsg(feature);
  expectSame(feature, fromMsg(feature_message, FieldReader(feature_message)));
}

TEST(Conversions, RoundingOfAQuaternionIsKeptAsItIs) {
  Random random;
  Eigen::Quaterniond q = random.pose().rotation;
  while (q.norm() == 1.0) q = q * random.pose().rotation;  // products as the libraries form them
  expectRoundTrip(vins::Pose(q, Vector3d::Zero()));
}

TEST(Conversions, EverySeverityComesBack) {
  for (const auto severity :
       {vins::Severity::kInfo, vins::Severity::kWarning, vins::Severity::kError}) {
    vins::Event event;
    event.severity = severity;
    EXPECT_EQ(fromMsg(toMsg(event)).severity, severity);
  }
}

TEST(Conversions, FieldsStandWhereTheMessageSays) {
  const vins::Pose pose({0.8, 0.0, 0.6, 0.0}, {1.0, 2.0, 3.0});
  const geometry_msgs::Pose pose_message = toMsg(pose);
  EXPECT_EQ(pose_message.orientation.w, 0.8);
  EXPECT_EQ(pose_message.orientation.y, 0.6);
  EXPECT_EQ(pose_message.position.z, 3.0);

  vins::LoopEdge edge;
  edge.covariance(1, 4) = 7.0;  // row-major: 1 * 6 + 4
  EXPECT_EQ(toMsg(edge).covariance[10], 7.0);

  const vins::ImuSample sample{kStamp, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  const sensor_msgs::Imu imu_message = toMsg(sample);
  EXPECT_EQ(imu_message.linear_acceleration.y, 2.0);
  EXPECT_EQ(imu_message.angular_velocity.z, 6.0);
  EXPECT_EQ(imu_message.orientation_covariance[0], -1.0);  // sensor_msgs/Imu: not measured
  EXPECT_EQ(imu_message.orientation.w, 1.0);  // and yet a rotation, for who looks at it
}

// Stamps.

TEST(Conversions, StampsAreExact) {
  for (const vins::Stamp stamp : {vins::Stamp{0}, vins::Stamp{1}, vins::Stamp{999999999},
                                  vins::Stamp{1000000000}, kStamp, kLastStamp}) {
    EXPECT_EQ(toStamp(toRosTime(stamp)), stamp);
  }
  EXPECT_EQ(toRosTime(kStamp).sec, 1403636580U);
  EXPECT_EQ(toRosTime(kStamp).nsec, 838555648U);
  EXPECT_EQ(toRosTime(kLastStamp), ros::TIME_MAX);
}

TEST(Conversions, StampsThatRosCannotHoldAreRefused) {
  EXPECT_EQ(refusal([] { toRosTime(-1); }),
            "stamp -1 ns; allowed in ROS: 0 to 4294967295999999999 ns");
  EXPECT_EQ(refusal([] { toRosTime(kLastStamp + 1); }),
            "stamp 4294967296000000000 ns; allowed in ROS: 0 to 4294967295999999999 ns");
  const std::string expected =
      "stamp -9223372036854775808 ns; allowed in ROS: 0 to 4294967295999999999 ns";
  constexpr vins::Stamp kBad = std::numeric_limits<vins::Stamp>::min();
  EXPECT_EQ(refusal([] { toMsg(vins::FeatureFrame{kBad, 0, {}}); }), expected);
  EXPECT_EQ(refusal([] {
              toMsg(vins::ImuSample{kBad, Vector3d::Zero(), Vector3d::Zero()});
            }),
            expected);
}

// What is handed on although it is not finite.

TEST(HandedOn, ImuSampleWithNaN) {
  vins::ImuSample sample = Random().imuSample();
  sample.acceleration.y() = kNaN;
  sample.angular_velocity.z() = kInfinity;
  const vins::ImuSample received = fromMsg(throughTheWire(toMsg(sample)));
  EXPECT_EQ(received.stamp, sample.stamp);
  EXPECT_FALSE(received.isFinite());
  EXPECT_TRUE(std::isnan(received.acceleration.y()));
  EXPECT_EQ(received.acceleration.x(), sample.acceleration.x());
  EXPECT_EQ(received.angular_velocity, sample.angular_velocity);
}

TEST(HandedOn, EventWithFiguresThatAreNotFinite) {
  vins::Event event;
  event.figures = {{"position_m", kNaN}, {"velocity_m_s", kInfinity}};
  const vins::Event received = fromMsg(toMsg(event));
  EXPECT_TRUE(std::isnan(received.figures.at(0).second));
  EXPECT_EQ(received.figures.at(1), event.figures[1]);
}

}  // namespace
}  // namespace vins_msgs
