#include "odometry_hold.h"

#include <gtest/gtest.h>

#include "vins_msgs/conversions.h"

namespace vins::pose_graph {
namespace {

nav_msgs::Odometry odometryAt(double seconds) {
  nav_msgs::Odometry odometry;
  odometry.header.stamp = vins_msgs::toRosTime(toNanoseconds(seconds));
  return odometry;
}

Keyframe keyframeAt(double seconds, std::uint32_t sequence) {
  Keyframe keyframe;
  keyframe.stamp = toNanoseconds(seconds);
  keyframe.sequence = sequence;
  return keyframe;
}

class OdometryHoldTest : public ::testing::Test {
 protected:
  OdometryHoldTest() {
    hold_.addKeyframe(keyframeAt(99.0, 0));
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(hold_.addOdometry(odometryAt(100.0 + 0.05 * i)).size(), 1u) << i;
    }
  }
  OdometryHold hold_;
};

TEST_F(OdometryHoldTest, AfterAPauseOdometryWaitsForTheKeyframeOfItsSequence) {
  EXPECT_TRUE(hold_.addOdometry(odometryAt(103.0)).empty());
  EXPECT_TRUE(hold_.addOdometry(odometryAt(103.05)).empty());
  EXPECT_TRUE(hold_.addKeyframe(keyframeAt(100.4, 0)).empty()) << "one from before the pause";
  const auto released = hold_.addKeyframe(keyframeAt(102.5, 1));
  ASSERT_EQ(released.size(), 2u);
  EXPECT_EQ(vins_msgs::toStamp(released[0].header.stamp), toNanoseconds(103.0));
  EXPECT_EQ(hold_.addOdometry(odometryAt(103.1)).size(), 1u);
}

TEST_F(OdometryHoldTest, AKeyframeThatWasFasterIsEnough) {
  EXPECT_TRUE(hold_.addKeyframe(keyframeAt(102.5, 1)).empty()) << "nothing was held";
  EXPECT_EQ(hold_.addOdometry(odometryAt(103.0)).size(), 1u);
}

TEST_F(OdometryHoldTest, ARecordingThatBeginsAgainWaitsToo) {
  EXPECT_TRUE(hold_.addOdometry(odometryAt(50.0)).empty());
  EXPECT_EQ(hold_.addKeyframe(keyframeAt(49.0, 1)).size(), 1u);
}

TEST_F(OdometryHoldTest, APauseOfImagesHoldsOnlyAFew) {
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(hold_.addOdometry(odometryAt(103.0 + 0.05 * i)).empty()) << i;
  }
  EXPECT_EQ(hold_.addOdometry(odometryAt(103.2)).size(), 5u);
  EXPECT_EQ(hold_.addOdometry(odometryAt(103.25)).size(), 1u);
}

}  // namespace
}  // namespace vins::pose_graph
