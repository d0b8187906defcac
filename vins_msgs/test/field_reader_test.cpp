#include "vins_msgs/field_reader.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "test_values.h"
#include "vins_msgs/conversions.h"

namespace vins_msgs {
namespace {

// Refusals. Each spoils one field of a good message.

template <typename Message, typename Spoil>
std::string refusalOf(Message message, const Spoil& spoil) {
  spoil(message);
  return refusal([&] { fromMsg(message); });
}

std::string refusedFrame(const std::function<void(FeatureFrame&)>& spoil) {
  vins::FeatureFrame frame = Random().featureFrame();
  frame.stamp = kStamp;
  return refusalOf(toMsg(frame), spoil);
}

TEST(Refusals, FeatureFrame) {
  const std::string place = "vins_msgs/FeatureFrame at 1403636580.838555648: observations[2].";
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) { m.observations[2].pixel[1] = kNaN; }),
            place + "pixel has nan at index 1; allowed: finite numbers");
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) { m.observations[2].bearing[0] = kInfinity; }),
            place + "bearing has inf at index 0; allowed: finite numbers");
  EXPECT_EQ(
      refusedFrame([](FeatureFrame& m) { m.observations[2].bearing_velocity[2] = -kInfinity; }),
      place + "bearing_velocity has -inf at index 2; allowed: finite numbers");
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) {
              m.observations[2].bearing = {{0.0, 0.75, 1.0}};
            }),
            place + "bearing has length 1.25; allowed: 1 within 1e-06");
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) { m.observations[2].angular_resolution = 0.0; }),
            place + "angular_resolution is 0; allowed: a finite number above 0");
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) { m.observations[2].camera = 2; }),
            place + "camera is 2; allowed: 0 to 1");
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) { m.observations[2].camera = -1; }),
            place + "camera is -1; allowed: 0 to 1");
  EXPECT_EQ(refusedFrame([](FeatureFrame& m) { m.observations[2].track_length = 0; }),
            place + "track_length is 0; allowed: 1 to 2147483647");
}

std::string refusedKeyframe(const std::function<void(Keyframe&)>& spoil) {
  vins::Keyframe keyframe = Random().keyframe();
  keyframe.stamp = 12'000'000'005;
  return refusalOf(toMsg(keyframe), spoil);
}

TEST(Refusals, Keyframe) {
  const std::string place = "vins_msgs/Keyframe at 12.000000005: ";
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) { m.T_wb.position.y = kNaN; }),
            place + "T_wb.position has nan at index 1; allowed: finite numbers");
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) { m.T_wb.orientation.w = kInfinity; }),
            place + "T_wb.orientation has inf at index 3; allowed: finite numbers");
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) { m.T_bc.orientation = {}; }),
            place + "T_bc.orientation has length 0; allowed: 1 within 0.001");
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) { m.covariance[35] = kNaN; }),
            place + "covariance has nan at index 35; allowed: finite numbers");
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) { m.points[1].pixel[0] = kNaN; }),
            place + "points[1].pixel has nan at index 0; allowed: finite numbers");
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) {
              m.points[0].bearing = {{0.0, 0.0, 0.0}};
            }),
            place + "points[0].bearing has length 0; allowed: 1 within 1e-06");
  EXPECT_EQ(refusedKeyframe([](Keyframe& m) { m.points[1].position_w[2] = kInfinity; }),
            place + "points[1].position_w has inf at index 2; allowed: finite numbers");
}

TEST(Refusals, KeyframePoseUpdate) {
  vins::KeyframePoseUpdate update = Random().poseUpdate();
  update.stamp = 1;
  EXPECT_EQ(
      refusalOf(toMsg(update),
                [](KeyframePoseUpdate& m) {
                  m.T_wb.orientation.w = m.T_wb.orientation.x = m.T_wb.orientation.y =
                      m.T_wb.orientation.z = 1.0;
                }),
      "vins_msgs/KeyframePoseUpdate at 0.000000001: T_wb.orientation has length 2; allowed: 1 "
      "within 0.001");
}

std::string refusedMatch(const std::function<void(LoopMatch&)>& spoil) {
  vins::LoopMatch match = Random().loopMatch();
  match.query_stamp = 1'000'000'000;
  return refusalOf(toMsg(match), spoil);
}

TEST(Refusals, LoopMatch) {
  const std::string place = "vins_msgs/LoopMatch at 1.000000000: ";
  EXPECT_EQ(refusedMatch([](LoopMatch& m) { m.T_wb_old.position.x = kNaN; }),
            place + "T_wb_old.position has nan at index 0; allowed: finite numbers");
  EXPECT_EQ(refusedMatch([](LoopMatch& m) { m.T_bc_old.position.z = kNaN; }),
            place + "T_bc_old.position has nan at index 2; allowed: finite numbers");
  EXPECT_EQ(refusedMatch([](LoopMatch& m) { m.T_old_query.orientation.x = kNaN; }),
            place + "T_old_query.orientation has nan at index 0; allowed: finite numbers");
  EXPECT_EQ(refusedMatch([](LoopMatch& m) {
              m.features[2].bearing_old = {{0.0, 2.0, 0.0}};
            }),
            place + "features[2].bearing_old has length 2; allowed: 1 within 1e-06");
}

std::string refusedEdge(const std::function<void(LoopEdge&)>& spoil) {
  vins::LoopEdge edge = Random().loopEdge();
  edge.query_stamp = 1'000'000'000;
  return refusalOf(toMsg(edge), spoil);
}

TEST(Refusals, LoopEdge) {
  const std::string place = "vins_msgs/LoopEdge at 1.000000000: ";
  EXPECT_EQ(refusedEdge([](LoopEdge& m) { m.T_old_query.position.y = kInfinity; }),
            place + "T_old_query.position has inf at index 1; allowed: finite numbers");
  EXPECT_EQ(refusedEdge([](LoopEdge& m) { m.covariance[6] = kNaN; }),
            place + "covariance has nan at index 6; allowed: finite numbers");
  EXPECT_EQ(refusedEdge([](LoopEdge& m) { m.inliers = -1; }),
            place + "inliers is -1; allowed: 0 to 2147483647");
}

std::string refusedBias(const std::function<void(ImuBias&)>& spoil) {
  vins::ImuBiasEstimate bias = Random().imuBias();
  bias.stamp = 1'000'000'000;
  return refusalOf(toMsg(bias), spoil);
}

TEST(Refusals, ImuBias) {
  const std::string place = "vins_msgs/ImuBias at 1.000000000: ";
  EXPECT_EQ(refusedBias([](ImuBias& m) { m.accelerometer.x = kNaN; }),
            place + "accelerometer has nan at index 0; allowed: finite numbers");
  EXPECT_EQ(refusedBias([](ImuBias& m) { m.gyroscope.y = kInfinity; }),
            place + "gyroscope has inf at index 1; allowed: finite numbers");
  EXPECT_EQ(refusedBias([](ImuBias& m) { m.accelerometer_covariance[3] = kNaN; }),
            place + "accelerometer_covariance has nan at index 3; allowed: finite numbers");
  EXPECT_EQ(refusedBias([](ImuBias& m) { m.gyroscope_covariance[8] = kNaN; }),
            place + "gyroscope_covariance has nan at index 8; allowed: finite numbers");
}

std::string refusedEvent(const std::function<void(Event&)>& spoil) {
  vins::Event event = Random().event();
  event.stamp = 1'000'000'000;
  return refusalOf(toMsg(event), spoil);
}

TEST(Refusals, Event) {
  const std::string place = "vins_msgs/Event at 1.000000000: ";
  EXPECT_EQ(refusedEvent([](Event& m) { m.figure_values.pop_back(); }),
            place + "figure_values has 2 elements; allowed: as many as figure_names, 3");
  EXPECT_EQ(refusedEvent([](Event& m) { m.figure_names.pop_back(); }),
            place + "figure_values has 3 elements; allowed: as many as figure_names, 2");
  EXPECT_EQ(refusedEvent([](Event& m) { m.severity = 3; }),
            place + "severity is 3; allowed: 0 to 2");
}

TEST(Refusals, MessageWithoutHeader) {
  EXPECT_EQ(refusal([] { fromMsg(geometry_msgs::Pose()); }),
            "geometry_msgs/Pose: orientation has length 0; allowed: 1 within 0.001");
}

// Tolerances: just inside and just outside of what field_reader.h states.

geometry_msgs::Pose poseWithQuaternionOfLength(double length) {
  return toMsg(vins::Pose({0.0, 0.6 * length, 0.0, 0.8 * length}, Eigen::Vector3d::Zero()));
}

TEST(Tolerances, QuaternionNearUnitLengthIsNormalized) {
  for (const double length : {1.0 - 0.99e-3, 1.0 - 1e-7, 1.0 + 1e-7, 1.0 + 0.99e-3}) {
    const vins::Pose pose = fromMsg(poseWithQuaternionOfLength(length));
    // Four roundings of a double of magnitude 1.
    EXPECT_LT((pose.rotation.coeffs() - Eigen::Vector4d(0.6, 0.0, 0.8, 0.0)).norm(), 1e-15);
  }
  for (const double length : {1.0 - 1.01e-3, 1.0 + 1.01e-3}) {
    EXPECT_THROW(fromMsg(poseWithQuaternionOfLength(length)), vins::InputError);
  }
}

FeatureFrame frameWithBearing(const Eigen::Vector3d& bearing) {
  vins::FeatureFrame frame;
  frame.observations.resize(1);
  frame.observations[0].bearing = bearing;
  return toMsg(frame);
}

TEST(Tolerances, BearingNearUnitLengthIsKeptAsItIs) {
  const Eigen::Vector3d unit(0.6, 0.0, 0.8);
  for (const double length : {1.0 - 0.99e-6, 1.0, 1.0 + 0.99e-6}) {
    const vins::FeatureFrame frame = fromMsg(frameWithBearing(length * unit));
    EXPECT_EQ(frame.observations[0].bearing, length * unit);
  }
  for (const double length : {1.0 - 1.01e-6, 1.0 + 1.01e-6}) {
    EXPECT_THROW(fromMsg(frameWithBearing(length * unit)), vins::InputError);
  }
}

}  // namespace
}  // namespace vins_msgs
