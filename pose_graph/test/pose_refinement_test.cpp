#include "pose_graph/loop/pose_refinement.h"

#include <random>

#include <gtest/gtest.h>

#include "vins_core/so3.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::pose_graph {
namespace {

using Eigen::Vector3d;

const Pose kTruth{so3::exp({0.3, -0.5, 0.9}), {0.4, -0.3, 1.2}};

std::vector<SeenPoint> pointsSeenFrom(const Pose& T_oq, int count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-5.0, 5.0);
  std::vector<SeenPoint> points;
  while (static_cast<int>(points.size()) < count) {
    const Vector3d p(uniform(random), uniform(random), uniform(random));
    points.push_back({p, (T_oq * p).normalized()});
  }
  return points;
}

TEST(BearingError, HasTheRightJacobian) {
  for (const SeenPoint& seen : pointsSeenFrom(kTruth, 10)) {
    // Some way off, so that the error is not zero.
    const Pose T =
        kTruth * se3::exp((se3::Vector6d() << 0.1, 0.2, -0.1, 0.1, -0.1, 0.05).finished());
    Eigen::Matrix<double, 3, 6> J;
    bearingError(seen, T, &J);
    const Eigen::MatrixXd numeric = vins::testing::numericJacobian(
        [&](const Eigen::VectorXd& xi) -> Eigen::VectorXd {
          return bearingError(seen, T * se3::exp(se3::Vector6d(xi)));
        },
        6);
    // The helper's error is of fourth order in its step of 1e-3.
    EXPECT_LT((J - numeric).norm(), 1e-8 * (1.0 + numeric.norm()));
  }
}

TEST(BearingError, IsTheChord) {
  const SeenPoint seen{Vector3d(0, 0, 7), Vector3d(std::sin(0.1), 0, std::cos(0.1))};
  EXPECT_NEAR(bearingError(seen, {}).norm(), 2.0 * std::sin(0.05), 1e-12);
  EXPECT_NEAR(bearingError({seen.point_q, -Vector3d::UnitZ()}, {}).norm(), 2.0, 1e-12);
}

TEST(RefinePose, FindsThePoseFromNearby) {
  Pose T = kTruth * se3::exp((se3::Vector6d() << 0.2, -0.1, 0.1, 0.05, 0.04, -0.06).finished());
  ASSERT_TRUE(refinePose(pointsSeenFrom(kTruth, 30), 0.01, &T));
  EXPECT_LT(se3::log(kTruth.inverse() * T).norm(), 1e-7);
}

TEST(RefinePose, BearsSomeOutliers) {
  auto points = pointsSeenFrom(kTruth, 60);
  for (std::size_t i = 0; i < 6; ++i) {
    points[i].bearing_o = (points[i].bearing_o + Vector3d(0.05, -0.04, 0.05)).normalized();
  }
  Pose T = kTruth;
  ASSERT_TRUE(refinePose(points, 0.002, &T));
  // Each outlier pulls no more than 0.002: six of sixty no more than about a tenth of that.
  EXPECT_LT(se3::log(kTruth.inverse() * T).norm(), 0.005);
}

TEST(RefinePose, SaysWhereThePoseIsNotDetermined) {
  Pose T = kTruth;
  EXPECT_FALSE(refinePose({}, 0.01, &T));
  EXPECT_FALSE(refinePose(pointsSeenFrom(kTruth, 2), 0.01, &T));
  const SeenPoint at_centre{kTruth.inverse() * Vector3d::Zero(), Vector3d::UnitZ()};
  EXPECT_FALSE(refinePose({at_centre, at_centre, at_centre}, 0.01, &T));
  EXPECT_EQ(T.position, kTruth.position);
}

}  // namespace
}  // namespace vins::pose_graph
