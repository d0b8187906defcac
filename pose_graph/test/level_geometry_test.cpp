#include "pose_graph/loop/level_geometry.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "vins_core/so3.h"

namespace vins::pose_graph {
namespace {

using Eigen::Vector3d;

class LevelGeometryTest : public ::testing::Test {
 protected:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Vector3d uniform3(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }

  std::mt19937_64 random_{1};
};

TEST_F(LevelGeometryTest, YawAddsUpAboutTheVertical) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond R = so3::exp(uniform3(1.0));
    const double yaw = uniform(-1.0, 1.0);
    EXPECT_NEAR(std::remainder(yawOf(yawRotation(yaw) * R) - yaw - yawOf(R), 2.0 * M_PI), 0, 1e-12);
    EXPECT_NEAR(yawOf(R), -yawOf(R.conjugate()), 1e-12);
    const Eigen::Quaterniond negative(-R.w(), -R.x(), -R.y(), -R.z());
    EXPECT_NEAR(yawOf(R), yawOf(negative), 1e-12);
  }
}

TEST_F(LevelGeometryTest, TwoPointsGiveThePoseBack) {
  for (int i = 0; i < 500; ++i) {
    const YawTranslation truth{uniform(-M_PI, M_PI), uniform3(3.0)};
    LevelPoint seen[2];
    for (LevelPoint& one : seen) {
      // All around: directions need not be before the camera.
      one.point = uniform3(8.0);
      one.direction = (truth * one.point).normalized();
    }
    double best = 1e9;
    for (const YawTranslation& found : solveTwoPoints(seen[0], seen[1])) {
      best = std::min(best, std::abs(std::remainder(found.yaw - truth.yaw, 2.0 * M_PI)) +
                                (found.translation - truth.translation).norm());
      for (const LevelPoint& one : seen) {
        EXPECT_GT((found * one.point).normalized().dot(one.direction), 1.0 - 1e-9);
      }
    }
    // Closed form; where both solutions nearly meet, half of the digits are lost.
    EXPECT_LT(best, 1e-5);
  }
}

TEST_F(LevelGeometryTest, PointsThatDetermineNothingGiveNothing) {
  LevelPoint a, b;
  a.point = {1, 2, 3};
  b.point = {1, 2, 5};  // straight above
  a.direction = Vector3d(1, 0, 0.1).normalized();
  b.direction = Vector3d(1, 0, 0.5).normalized();
  EXPECT_TRUE(solveTwoPoints(a, b).empty());
  b = a;
  EXPECT_TRUE(solveTwoPoints(a, b).empty());
  b.point = {4, 5, 6};  // another point in the same direction
  EXPECT_TRUE(solveTwoPoints(a, b).empty());
}

TEST_F(LevelGeometryTest, ThreeBearingsGiveTheMotionBack) {
  int found_again = 0;
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    const YawTranslation truth{uniform(-0.5, 0.5), uniform3(1.5)};
    std::array<LevelBearings, 3> pairs;
    for (LevelBearings& pair : pairs) {
      const Vector3d p = uniform3(8.0);
      pair = {p.normalized(), (truth * p).normalized()};
    }
    bool is_found = false;
    for (const YawDirection& found : solveThreeBearings(pairs, 0.6)) {
      for (const LevelBearings& pair : pairs) EXPECT_LT(epipolarError(pair, found), 1e-3);
      const double cosine = std::abs(found.direction.dot(truth.translation.normalized()));
      is_found = is_found || (std::abs(found.yaw - truth.yaw) < 1e-3 && cosine > 0.999);
    }
    found_again += is_found ? 1 : 0;
  }
  // Two roots within one step of the search escape it: of the samples that are drawn, some may.
  EXPECT_GE(found_again, kTrials * 9 / 10);
}

TEST_F(LevelGeometryTest, EpipolarErrorIsTheAngleFromThePlane) {
  const YawDirection sideways{0.0, Vector3d::UnitY()};
  // The plane of the direction y and the bearing x is z = 0.
  const LevelBearings pair{Vector3d::UnitX(), Vector3d(1.0, 0.3, 0.01).normalized()};
  EXPECT_NEAR(epipolarError(pair, sideways), 0.01 / std::hypot(1.0, 0.3), 1e-6);
  // At the epipole no plane is the right one.
  const LevelBearings along{Vector3d::UnitY(), Vector3d(0.01, 1.0, 0.0).normalized()};
  EXPECT_NEAR(epipolarError(along, sideways), 0.0, 1e-9);
}

TEST_F(LevelGeometryTest, EpipolarErrorDoesNotKnowTheDirectionsSign) {
  for (int i = 0; i < 20; ++i) {
    const LevelBearings pair{uniform3(1.0).normalized(), uniform3(1.0).normalized()};
    const YawDirection motion{uniform(-1, 1), uniform3(1.0).normalized()};
    EXPECT_DOUBLE_EQ(epipolarError(pair, motion),
                     epipolarError(pair, {motion.yaw, -motion.direction}));
  }
}

}  // namespace
}  // namespace vins::pose_graph
