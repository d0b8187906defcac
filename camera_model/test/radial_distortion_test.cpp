#include "camera_model/radial_distortion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "camera_model/radtan_distortion.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::camera_model {
namespace {

TEST(RadialDistortion, InverseIsExactUpToTheEndOfTheRange) {
  for (const std::array<double, 4>& c : {std::array<double, 4>{-0.28, 0.07, 0.0, 0.0},
                                         {0.2, 0.1, 0.05, 0.01},
                                         {-1.0 / 3.0, 0.0, 0.0, 0.0},
                                         {0.0, 0.0, 0.0, 0.0},
                                         {-0.01, 0.02, -0.03, 0.004}}) {
    const RadialDistortion polynomial(c, 3.0, 0.8);
    for (int i = 0; i <= 1000; ++i) {
      const double r = polynomial.maxRadius() * i / 1000.0;
      const auto back = polynomial.invert(r * polynomial.ratio(r * r));
      ASSERT_TRUE(back || i == 1000) << c[0] << " " << r;
      // The slope is 1 / 50 or more: rounding grows to hundreds of units in the last place.
      EXPECT_NEAR(back.value_or(r), r, 2e-13) << c[0];
    }
    EXPECT_FALSE(polynomial.invert(polynomial.maxDistorted() * 1.001));
  }
}

TEST(RadialDistortion, RangeEndsWhereTheMapFoldsOver) {
  // Slope 1 - r^2.
  const RadialDistortion folding({-1.0 / 3.0, 0.0, 0.0, 0.0}, 5.0, 1.0);
  EXPECT_NEAR(folding.maxRadius(), std::sqrt(1.0 - RadialDistortion::kMinSlope), 1e-9);
  EXPECT_EQ(RadialDistortion({0.1, 0.0, 0.0, 0.0}, 5.0, 1.0).maxRadius(), 5.0);
}

TEST(RadialDistortion, SlopeIsTheDerivative) {
  const RadialDistortion polynomial({-0.3, 0.2, -0.1, 0.05}, 3.0, 1.0);
  for (const double r : {0.0, 0.3, 0.9}) {
    const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      const double x = r + d[0];
      return Eigen::VectorXd::Constant(1, x * polynomial.ratio(x * x));
    };
    EXPECT_NEAR(polynomial.slope(r * r), vins::testing::numericJacobian(f, 1)(0, 0), 1e-10);
  }
}

TEST(RadialDistortion, StartIsNearTheInverseWithinReachAndBeyond) {
  const RadialDistortion polynomial({-0.28, 0.07, 0.0, 0.0}, 1.5, 0.7);
  for (double d = 0.01; d < polynomial.maxDistorted(); d += 0.01) {
    EXPECT_NEAR(d * polynomial.nearInverseRatio(d * d), *polynomial.invert(d), 1e-4);
  }
}

TEST(RadialDistortion, RationalInverseIsExactUpToTheEndOfTheRange) {
  struct Case {
    std::array<double, 4> numerator;
    std::array<double, 3> denominator;
  };
  // A calibrated wide lens, a numerator that folds, and a pole at r = 1.
  for (const Case& c : {Case{{0.5, -2.6, 1.5, 0.0}, {0.39, -2.4, 1.43}},
                        Case{{-0.3, -0.1, 0.0, 0.0}, {0.2, 0.1, 0.0}},
                        Case{{0.0, 0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}}}) {
    const RadialDistortion rational(c.numerator, 3.0, 0.8, c.denominator);
    EXPECT_GT(rational.maxRadius(), 0.5);
    for (int i = 0; i < 1000; ++i) {
      const double r = rational.maxRadius() * i / 1000.0;
      const auto back = rational.invert(r * rational.ratio(r * r));
      ASSERT_TRUE(back) << r;
      EXPECT_NEAR(*back, r, 1e-12) << r;
    }
    EXPECT_FALSE(rational.invert(rational.maxDistorted() * 1.001));
  }
}

TEST(RadialDistortion, RationalRangeEndsWhereTheMapFoldsOverAndBeforeAPole) {
  // d = r / (1 + r^2) has its maximum at r = 1.
  const RadialDistortion folding({}, 5.0, 0.4, {1.0, 0.0, 0.0});
  EXPECT_LT(folding.maxRadius(), 1.0);
  EXPECT_NEAR(folding.slope(std::pow(folding.maxRadius(), 2)), RadialDistortion::kMinSlope, 1e-9);
  const RadialDistortion pole({}, 5.0, 1.0, {0.0, -1.0, 0.0});
  EXPECT_NEAR(pole.maxRadius(), std::pow(1.0 - RadialDistortion::kMinDenominator, 0.25), 1e-9);
  // A numerator and a denominator that are alike leave a radius as it is.
  const RadialDistortion none({0.3, 0.2, 0.1, 0.0}, 5.0, 1.0, {0.3, 0.2, 0.1});
  EXPECT_EQ(none.maxRadius(), 5.0);
  EXPECT_NEAR(*none.invert(2.0), 2.0, 1e-14);
}

TEST(RadialDistortion, RationalDerivativesAgreeWithNumericDifferences) {
  const RadialDistortion rational({-0.3, 0.2, -0.1, 0.0}, 3.0, 1.0, {0.2, -0.3, 0.15});
  for (const double r : {0.0, 0.3, 0.9}) {
    const auto d = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
      const double x = r + step[0];
      return Eigen::VectorXd::Constant(1, x * rational.ratio(x * x));
    };
    EXPECT_NEAR(rational.slope(r * r), vins::testing::numericJacobian(d, 1)(0, 0), 1e-9);
    const auto ratio = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, rational.ratio(r * r + step[0]));
    };
    EXPECT_NEAR(rational.ratioDerivative(r * r), vins::testing::numericJacobian(ratio, 1)(0, 0),
                1e-9);
  }
}

TEST(RadtanDistortion, UndistortsToTheLastDigits) {
  const RadtanDistortion distortion({-0.28, 0.07, 0.004, -0.003, -0.01}, 0.9);
  for (double x = -0.9; x <= 0.9; x += 0.1) {
    for (double y = -0.7; y <= 0.7; y += 0.1) {
      const Eigen::Vector2d point(x, y);
      const auto back = distortion.undistort(*distortion.distort(point, nullptr, nullptr));
      ASSERT_TRUE(back);
      // The last step was below 1e-6, and Newton's method squares the error.
      EXPECT_LT((*back - point).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace vins::camera_model
