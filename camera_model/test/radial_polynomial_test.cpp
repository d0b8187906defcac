#include "camera_model/radial_polynomial.h"

#include <cmath>

#include <gtest/gtest.h>

#include "camera_model/radtan_distortion.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::camera_model {
namespace {

TEST(RadialPolynomial, InverseIsExactUpToTheEndOfTheRange) {
  for (const std::array<double, 4>& c : {std::array<double, 4>{-0.28, 0.07, 0.0, 0.0},
                                         {0.2, 0.1, 0.05, 0.01},
                                         {-1.0 / 3.0, 0.0, 0.0, 0.0},
                                         {0.0, 0.0, 0.0, 0.0},
                                         {-0.01, 0.02, -0.03, 0.004}}) {
    const RadialPolynomial polynomial(c, 3.0, 0.8);
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

TEST(RadialPolynomial, RangeEndsWhereTheMapFoldsOver) {
  // Slope 1 - r^2.
  const RadialPolynomial folding({-1.0 / 3.0, 0.0, 0.0, 0.0}, 5.0, 1.0);
  EXPECT_NEAR(folding.maxRadius(), std::sqrt(1.0 - RadialPolynomial::kMinSlope), 1e-9);
  EXPECT_EQ(RadialPolynomial({0.1, 0.0, 0.0, 0.0}, 5.0, 1.0).maxRadius(), 5.0);
}

TEST(RadialPolynomial, SlopeIsTheDerivative) {
  const RadialPolynomial polynomial({-0.3, 0.2, -0.1, 0.05}, 3.0, 1.0);
  for (const double r : {0.0, 0.3, 0.9}) {
    const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      const double x = r + d[0];
      return Eigen::VectorXd::Constant(1, x * polynomial.ratio(x * x));
    };
    EXPECT_NEAR(polynomial.slope(r * r), vins::testing::numericJacobian(f, 1)(0, 0), 1e-10);
  }
}

TEST(RadialPolynomial, StartIsNearTheInverseWithinReachAndBeyond) {
  const RadialPolynomial polynomial({-0.28, 0.07, 0.0, 0.0}, 1.5, 0.7);
  for (double d = 0.01; d < polynomial.maxDistorted(); d += 0.01) {
    EXPECT_NEAR(d * polynomial.nearInverseRatio(d * d), *polynomial.invert(d), 1e-4);
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
