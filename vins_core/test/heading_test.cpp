#include "vins_core/heading.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vins_core/so3.h"

namespace vins {
namespace {

TEST(Heading, WrapsAngles) {
  EXPECT_DOUBLE_EQ(wrapAngle(M_PI), M_PI);
  EXPECT_DOUBLE_EQ(wrapAngle(-M_PI), M_PI);
  EXPECT_NEAR(wrapAngle(7.0), 7.0 - 2.0 * M_PI, 1e-15);
  EXPECT_DOUBLE_EQ(wrapAngle(-0.5), -0.5);
}

TEST(Heading, YawOfIsWhatTurnsAboutTheVertical) {
  // Tilts without twist: rotation vectors in the horizontal plane, one of a quarter turn.
  for (const Eigen::Vector3d& tilt :
       {Eigen::Vector3d(0.3, -0.2, 0.0), Eigen::Vector3d(0.0, -M_PI_2, 0.0)}) {
    for (const double yaw : {-3.0, -0.4, 0.0, 1.0, 3.1}) {
      const Eigen::Quaterniond R = yawRotation(yaw) * so3::exp(tilt);
      EXPECT_NEAR(yawOf(R), yaw, 1e-12);
      // A few roundings of numbers up to pi.
      EXPECT_NEAR(wrapAngle(yawOf(yawRotation(0.7) * R) - yaw - 0.7), 0.0, 1e-12);
      EXPECT_NEAR(yawOf(Eigen::Quaterniond(-R.coeffs())), yaw, 1e-12);
    }
  }
}

}  // namespace
}  // namespace vins
