#include "vins_core/pose_covariance.h"

#include <random>

#include <gtest/gtest.h>

#include "vins_core/so3.h"

namespace vins {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using se3::Matrix6d;
using se3::Vector6d;

constexpr double kRounding = 1e-12;

Matrix6d someCovariance(int seed, double scale) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(seed));
  std::normal_distribution<double> normal;
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i) = normal(engine);
  return scale * scale * (A * A.transpose() + 0.1 * Matrix6d::Identity());
}

const Pose kPose(so3::exp({0.4, -1.1, 2.0}), {3.0, -2.0, 1.0});
const Pose kNext(so3::exp({-0.7, 0.3, 0.5}), {-1.0, 4.0, 0.5});

/// The pose with an error about fixed axes.
Pose disturbed(const Pose& T_ab, const Vector6d& d) {
  return {so3::exp(d.tail<3>()) * T_ab.rotation, T_ab.position + d.head<3>()};
}

Vector6d errorOf(const Pose& T, const Pose& reference) {
  Vector6d d;
  d << T.position - reference.position, so3::log(T.rotation * reference.rotation.conjugate());
  return d;
}

TEST(PoseCovariance, YawOfABodyThatPointsUpIsYawAboutFixedAxes) {
  // EuRoC's body: x up. An error of 0.1 rad about the vertical is one about the body's x.
  const Quaterniond R_wb = so3::exp({0.0, -M_PI / 2.0, 0.0});
  ASSERT_LT((R_wb * Vector3d::UnitX() - Vector3d::UnitZ()).norm(), kRounding);
  Matrix6d body = Matrix6d::Zero();
  body(3, 3) = 0.01;
  body(0, 3) = body(3, 0) = 0.002;  // of position along x with yaw
  const Matrix6d fixed = aboutFixedAxes(R_wb, body);
  EXPECT_NEAR(fixed(5, 5), 0.01, kRounding);
  EXPECT_NEAR(fixed(3, 3), 0.0, kRounding);
  EXPECT_NEAR(fixed(0, 5), 0.002, kRounding);
  EXPECT_NEAR(fixed(5, 0), 0.002, kRounding);
  EXPECT_NEAR(fixed(0, 3), 0.0, kRounding);
  EXPECT_LT((aboutBodyAxes(R_wb, fixed) - body).norm(), kRounding);
}

TEST(PoseCovariance, OfAProductIsThatOfManyProducts) {
  const Matrix6d first = someCovariance(1, 3e-3), second = someCovariance(2, 2e-3);
  const Matrix6d expected = covarianceOfProduct(kPose, first, kNext, second);
  const Matrix6d L1 = first.llt().matrixL(), L2 = second.llt().matrixL();
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  Matrix6d sum = Matrix6d::Zero();
  constexpr int kRuns = 40000;
  for (int run = 0; run < kRuns; ++run) {
    Vector6d a, b;
    for (int i = 0; i < 6; ++i) a(i) = normal(engine), b(i) = normal(engine);
    const Vector6d d = errorOf(disturbed(kPose, L1 * a) * disturbed(kNext, L2 * b), kPose * kNext);
    sum += d * d.transpose() / kRuns;
  }
  // An entry's deviation is sqrt(2 / 40000) = 0.7 % of the product of its two deviations.
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      EXPECT_NEAR(sum(i, j), expected(i, j), 0.03 * std::sqrt(expected(i, i) * expected(j, j)));
    }
  }
}

TEST(PoseCovariance, ByAPointIsUndoneByPlacingThePoint) {
  const Matrix6d of_point = someCovariance(3, 1e-2);
  const Vector3d p_b(5.0, -4.0, 2.0);
  const Matrix6d of_transform = covarianceByPoint(kPose.rotation * p_b, of_point);
  const Matrix6d back =
      covarianceOfProduct(kPose, of_transform, {Quaterniond::Identity(), p_b}, Matrix6d::Zero());
  EXPECT_LT((back - of_point).norm(), 1e-12);
}

}  // namespace
}  // namespace vins
