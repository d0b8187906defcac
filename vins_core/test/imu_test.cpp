#include "vins_core/imu.h"

#include <gtest/gtest.h>

namespace vins {
namespace {

TEST(Imu, ReadingsBetweenTwoLieOnALine) {
  const ImuSample from{1000, {1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}};
  const ImuSample to{5000, {5.0, 2.0, -1.0}, {0.1, -0.2, 0.7}};
  const ImuSample quarter = interpolate(from, to, 2000);
  EXPECT_EQ(quarter.stamp, 2000);
  EXPECT_LT((quarter.acceleration - Eigen::Vector3d(2.0, 2.0, 2.0)).norm(), 1e-15);
  EXPECT_LT((quarter.angular_velocity - Eigen::Vector3d(0.1, 0.1, 0.4)).norm(), 1e-15);
  EXPECT_EQ(interpolate(from, to, 1000).acceleration, from.acceleration);
  EXPECT_EQ(interpolate(from, to, 5000).angular_velocity, to.angular_velocity);
}

}  // namespace
}  // namespace vins
