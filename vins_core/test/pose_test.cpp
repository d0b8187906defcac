#include "vins_core/pose.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vins_core/so3.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using se3::Matrix6d;
using se3::Vector6d;

constexpr double kAngles[] = {0.0, 1e-160, 1e-9, 1e-4, 0.1, 0.4999, 0.5001, 2.0, M_PI - 1e-7};

class PoseTest : public ::testing::Test {
 protected:
  Vector3d vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }
  Vector6d tangent(double angle) {
    Vector6d xi;
    xi << vector(), angle * vector().normalized();
    return xi;
  }
  Pose pose() { return se3::exp(tangent(2.0)); }

  std::mt19937_64 random_{23};
  std::normal_distribution<double> normal_;
};

TEST_F(PoseTest, ProductAndInverseAreThoseOfTheMatrices) {
  const Pose a = pose(), b = pose();
  EXPECT_LT(((a * b).matrix() - a.matrix() * b.matrix()).norm(), 1e-14);
  EXPECT_LT((a.inverse().matrix() - a.matrix().inverse()).norm(), 1e-14);
  const Vector3d p = vector();
  EXPECT_LT((a * p - (a.matrix() * p.homogeneous()).head<3>()).norm(), 1e-14);
}

TEST_F(PoseTest, LongProductsStayRotations) {
  const Pose step = pose();
  Pose sum;
  for (int i = 0; i < 100000; ++i) sum = sum * step;
  EXPECT_NEAR(sum.rotation.norm(), 1.0, 1e-15);
}

TEST_F(PoseTest, FromMatrixTakesTheNearestRotation) {
  const Pose a = pose();
  Matrix4d T = a.matrix();
  T.topLeftCorner<3, 3>() += 1e-5 * Matrix3d::Random();
  const Pose b = poseFromMatrix(T);
  EXPECT_LT((b.matrix() - a.matrix()).norm(), 1e-4);
  EXPECT_NEAR(b.rotation.norm(), 1.0, 1e-15);
  EXPECT_LT((poseFromMatrix(a.matrix()).matrix() - a.matrix()).norm(), 1e-14);
}

/// The matrix exponential's power series: slow, and free of special cases.
Matrix4d matrixExponential(const Vector6d& xi) {
  Matrix4d A = Matrix4d::Zero();
  A.topLeftCorner<3, 3>() = so3::hat(xi.tail<3>());
  A.topRightCorner<3, 1>() = xi.head<3>();
  Matrix4d sum = Matrix4d::Identity(), term = Matrix4d::Identity();
  for (int n = 1; n < 60; ++n) sum += term = term * A / n;
  return sum;
}

TEST_F(PoseTest, ExpIsTheMatrixExponential) {
  for (const double angle : kAngles) {
    const Vector6d xi = tangent(angle);
    EXPECT_LT((se3::exp(xi).matrix() - matrixExponential(xi)).norm(), 1e-13) << angle;
  }
}

TEST_F(PoseTest, LogUndoesExp) {
  for (const double angle : kAngles) {
    const Vector6d xi = tangent(angle);
    const Pose T = se3::exp(xi);
    const Vector6d back = se3::log(T);
    EXPECT_LT((se3::exp(back).matrix() - T.matrix()).norm(), 1e-14) << angle;
    EXPECT_LT((back - xi).norm(), 1e-14) << angle;
  }
}

TEST_F(PoseTest, AdjointMovesAPerturbationToTheOtherSide) {
  const Pose T = pose();
  const Vector6d xi = 0.3 * tangent(1.0);
  const Pose right = T * se3::exp(xi);
  const Pose left = se3::exp(se3::adjoint(T) * xi) * T;
  EXPECT_LT((right.matrix() - left.matrix()).norm(), 1e-14);
}

TEST_F(PoseTest, RightJacobianAgreesWithNumericDifferences) {
  for (const double angle : kAngles) {
    const Vector6d xi = tangent(angle);
    const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return se3::log(se3::exp(xi).inverse() * se3::exp(xi + Vector6d(d)));
    };
    EXPECT_LT((se3::rightJacobian(xi) - testing::numericJacobian(f, 6)).norm(), 2e-11) << angle;
  }
}

TEST_F(PoseTest, InverseRightJacobianIsInverse) {
  for (const double angle : kAngles) {
    const Vector6d xi = tangent(angle);
    const Matrix6d product = se3::rightJacobian(xi) * se3::rightJacobianInverse(xi);
    EXPECT_LT((product - Matrix6d::Identity()).norm(), 2e-14) << angle;
  }
}

}  // namespace
}  // namespace vins
