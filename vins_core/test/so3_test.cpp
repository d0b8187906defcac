#include "vins_core/so3.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vins_core/testing/numeric_jacobian.h"

namespace vins {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Angles where closed forms and series meet, and the ends of the range.
constexpr double kAngles[] = {0.0, 1e-300, 1e-160, 1e-20, 1e-9, 1e-5,        1e-3,
                              0.1, 0.4999, 0.5001, 1.0,   2.5,  M_PI - 1e-9, M_PI};

class So3 : public ::testing::Test {
 protected:
  Vector3d axis() {
    return Vector3d(normal_(random_), normal_(random_), normal_(random_)).normalized();
  }

  std::mt19937_64 random_{17};
  std::normal_distribution<double> normal_;
};

TEST_F(So3, HatIsCrossProductAndVeeUndoesIt) {
  const Vector3d a(1.0, -2.0, 3.0), b(0.3, 0.5, -0.7);
  EXPECT_TRUE(so3::hat(a).operator*(b).isApprox(a.cross(b), 1e-15));
  EXPECT_EQ(so3::vee(so3::hat(a)), a);
}

TEST_F(So3, ExpAgreesWithRotationMatrixByRodrigues) {
  for (const double angle : {1e-8, 0.3, 3.0, M_PI, 5.0}) {
    const Vector3d u = axis();
    const Matrix3d K = so3::hat(u);
    const Matrix3d R = Matrix3d::Identity() + std::sin(angle) * K + (1.0 - std::cos(angle)) * K * K;
    EXPECT_LT((so3::exp(angle * u).toRotationMatrix() - R).norm(), 1e-14) << angle;
  }
}

TEST_F(So3, LogUndoesExpToTheLastDigitsForEveryAngle) {
  for (const double angle : kAngles) {
    const Vector3d phi = angle * axis();
    const Vector3d back = so3::log(so3::exp(phi));
    // At pi itself both signs of the axis are right.
    const double error = std::min((back - phi).norm(), angle > 3.14 ? (back + phi).norm() : 1.0);
    EXPECT_LE(error, 4e-16 * std::max(angle, 1e-300)) << angle;
  }
}

TEST_F(So3, LogIsTheSameForBothSignsAndForAnyLengthOfTheQuaternion) {
  const Quaterniond q = so3::exp(Vector3d(0.4, -1.1, 2.0));
  const Vector3d phi = so3::log(q);
  EXPECT_LT((so3::log(Quaterniond(-q.coeffs())) - phi).norm(), 1e-15);
  EXPECT_LT((so3::log(Quaterniond(3.0 * q.coeffs())) - phi).norm(), 1e-15);
}

TEST_F(So3, LogNeverExceedsPi) {
  for (int i = 0; i < 1000; ++i) {
    const Quaterniond q(normal_(random_), normal_(random_), normal_(random_), normal_(random_));
    EXPECT_LE(so3::log(q).norm(), M_PI * (1.0 + 1e-15));
  }
}

TEST_F(So3, JacobiansAgreeWithNumericDifferences) {
  for (const double angle : kAngles) {
    const Vector3d phi = angle * axis();
    const auto right = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return so3::log(so3::exp(phi).conjugate() * so3::exp(phi + d));
    };
    const auto left = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return so3::log(so3::exp(phi + d) * so3::exp(phi).conjugate());
    };
    // Differences of step 1e-3: truncation 1e-12, rounding 1e-16 / 1e-3.
    EXPECT_LT((so3::rightJacobian(phi) - testing::numericJacobian(right, 3)).norm(), 5e-12)
        << angle;
    EXPECT_LT((so3::leftJacobian(phi) - testing::numericJacobian(left, 3)).norm(), 5e-12) << angle;
  }
}

TEST_F(So3, InverseJacobiansAreInverse) {
  for (const double angle : kAngles) {
    const Vector3d phi = angle * axis();
    const Matrix3d I = Matrix3d::Identity();
    EXPECT_LT((so3::rightJacobian(phi) * so3::rightJacobianInverse(phi) - I).norm(), 5e-15);
    EXPECT_LT((so3::leftJacobian(phi) * so3::leftJacobianInverse(phi) - I).norm(), 5e-15);
  }
}

TEST_F(So3, JacobiansTurnIntoEachOther) {
  const Vector3d phi(0.3, -0.2, 0.9);
  const Matrix3d R = so3::exp(phi).toRotationMatrix();
  EXPECT_LT((so3::leftJacobian(phi) - R * so3::rightJacobian(phi)).norm(), 1e-15);
}

}  // namespace
}  // namespace vins
