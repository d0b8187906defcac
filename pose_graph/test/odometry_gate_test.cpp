#include "pose_graph/loop/odometry_gate.h"

#include <cmath>

#include <gtest/gtest.h>

#include "synthetic_keyframes.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::SyntheticKeyframes;

/// Three rounds of some 31 m each, 20 keyframes to a round, without drift.
constexpr int kRound = 20;

class OdometryGate : public ::testing::Test {
 protected:
  OdometryGate() { keyframes_.addTo(&graph_); }

  double travelled(int id) const { return graph_.vertices().at(id).travelled; }

  OdometryComparison compare(int query, int old, const Pose& T_old_query) const {
    const auto comparison = compareWithOdometry({}, graph_, query, old, T_old_query);
    EXPECT_TRUE(comparison);
    return comparison.value_or(OdometryComparison());
  }

  SyntheticKeyframes keyframes_{3 * kRound, kRound, 0.0, 1};
  KeyframeGraph graph_;
};

TEST_F(OdometryGate, TheWayIsThatOfTheOdometryEvenWhereKeyframesHaveGone) {
  EXPECT_EQ(travelled(0), 0.0);
  EXPECT_GT(travelled(kRound), 28.0);
  const double way = travelled(50) - travelled(3);
  EXPECT_NEAR(wayBetween(graph_, 50, 3).value(), way, 1e-9);
  EXPECT_NEAR(wayBetween(graph_, 3, 50).value(), way, 1e-9);
  // Straight across the circle it would be shorter.
  for (int id = 10; id < 40; ++id) graph_.removeKeyframe(id);
  EXPECT_NEAR(wayBetween(graph_, 50, 3).value(), way, 1e-9);
}

TEST_F(OdometryGate, LoopsShortenTheWay) {
  graph_.addLoopEdge(keyframes_.loop(0, 2 * kRound));
  const double from_old = travelled(3) - travelled(0);
  const double from_query = travelled(50) - travelled(2 * kRound);
  EXPECT_NEAR(wayBetween(graph_, 50, 3).value(), from_old + from_query, 1e-9);
}

TEST_F(OdometryGate, BelievesAnotherRunAnywhere) {
  SyntheticKeyframes(10, kRound, 0.0, 2).addTo(&graph_, 1, 100);
  EXPECT_FALSE(wayBetween(graph_, 105, 3));
  EXPECT_FALSE(wayBetween(graph_, 105, 1000));
  EXPECT_FALSE(compareWithOdometry({}, graph_, 105, 3, Pose()));
}

TEST_F(OdometryGate, TrueLoopsPassAndErrorsAreMeasured) {
  const Pose T_old_query = keyframes_.loop(5, 45).T_old_query;
  const OdometryComparison exact = compare(45, 5, T_old_query);
  EXPECT_TRUE(exact.is_plausible);
  EXPECT_LT(exact.position_error, 1e-9);
  EXPECT_LT(exact.yaw_error, 1e-9);
  // 60 m of way allow 1 + 1.8 m and 10 + 12 degrees.
  const auto moved = [&](double metres, double degrees) {
    const Pose& T_wo = keyframes_.truth[5];
    const Pose turn(yawRotation(degrees * M_PI / 180.0), Eigen::Vector3d::Zero());
    Pose T_wq = T_wo * T_old_query;
    T_wq.rotation = turn.rotation * T_wq.rotation;
    T_wq.position.x() += metres;
    return compare(45, 5, T_wo.inverse() * T_wq);
  };
  EXPECT_NEAR(moved(2.0, 20.0).position_error, 2.0, 1e-9);
  EXPECT_NEAR(moved(2.0, 20.0).yaw_error, 20.0 * M_PI / 180.0, 1e-9);
  EXPECT_TRUE(moved(2.0, 20.0).is_plausible);
  EXPECT_FALSE(moved(6.0, 0.0).is_plausible);
  EXPECT_FALSE(moved(0.0, 60.0).is_plausible);
}

TEST_F(OdometryGate, ACorridorThatLooksLikeAnotherIsNotIt) {
  // Half a round on, the same view from the same place: ten metres off and facing the other way.
  const OdometryComparison comparison = compare(30, kRound, Pose());
  EXPECT_GT(comparison.position_error, 5.0);
  EXPECT_FALSE(comparison.is_plausible);
}

TEST_F(OdometryGate, AfterALoopTheWayIsShortAndLittleIsAllowed) {
  graph_.addLoopEdge(keyframes_.loop(4, 44));
  Pose T_old_query = keyframes_.loop(5, 45).T_old_query;
  EXPECT_TRUE(compare(45, 5, T_old_query).is_plausible);
  T_old_query.position.x() += 2.0;  // 60 m without a loop would allow it
  EXPECT_FALSE(compare(45, 5, T_old_query).is_plausible);
}

TEST(OdometryGateOptions, AreChecked) {
  OdometryGateOptions options;
  EXPECT_NO_THROW(options.validate());
  options.position_share = -0.1;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.yaw_slack = std::nan("");
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
