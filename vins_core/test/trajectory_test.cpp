#include "vins_core/trajectory.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Pose kStart;
const Pose kEnd(so3::exp({0.0, 0.0, M_PI / 2.0}), Vector3d(3.0, 4.0, 0.0));

TEST(Trajectory, MeasuresDurationAndLength) {
  const Trajectory trajectory({{0, kStart}, {2000000000, kEnd}, {2500000000, kStart}});
  EXPECT_DOUBLE_EQ(trajectory.duration(), 2.5);
  EXPECT_DOUBLE_EQ(trajectory.length(), 10.0);
  EXPECT_EQ(Trajectory().duration(), 0.0);
  EXPECT_EQ(Trajectory().length(), 0.0);
}

TEST(Trajectory, InterpolatesPositionAndRotation) {
  const Trajectory trajectory({{0, kStart}, {1000000000, kEnd}});
  const auto quarter = trajectory.interpolate(250000000, 1.0);
  ASSERT_TRUE(quarter);
  EXPECT_LT((quarter->position - Vector3d(0.75, 1.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((so3::log(quarter->rotation) - Vector3d(0.0, 0.0, M_PI / 8.0)).norm(), 1e-15);
  EXPECT_EQ(trajectory.interpolate(1000000000, 1.0)->position, kEnd.position);
  EXPECT_EQ(trajectory.interpolate(0, 1.0)->position, kStart.position);
}

TEST(Trajectory, TakesTheShortestArcForQuaternionsOfOppositeSign) {
  const Pose end(Quaterniond(-kEnd.rotation.coeffs()), kEnd.position);
  const auto half = Trajectory({{0, kStart}, {2, end}}).interpolate(1, 1.0);
  EXPECT_NEAR(so3::log(half->rotation).z(), M_PI / 4.0, 1e-15);
}

TEST(Trajectory, GivesNothingOutsideOrInsideAGap) {
  const Trajectory trajectory({{1000, kStart}, {1000001000, kEnd}});
  EXPECT_FALSE(trajectory.interpolate(999, 10.0));
  EXPECT_FALSE(trajectory.interpolate(1000001001, 10.0));
  EXPECT_FALSE(trajectory.interpolate(2000, 0.9));
  EXPECT_TRUE(trajectory.interpolate(1000, 0.9));
  EXPECT_FALSE(Trajectory().interpolate(0, 1.0));
}

TEST(Trajectory, RefusesStampsThatDoNotRise) {
  EXPECT_THROW(Trajectory({{5, kStart}, {5, kEnd}}), InputError);
  EXPECT_THROW(Trajectory({{5, kStart}, {4, kEnd}}), InputError);
}

}  // namespace
}  // namespace vins
