#include "vins_estimator/visual/bearing_correction.h"

#include <gtest/gtest.h>

namespace vins::estimator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d bearingAt(const Vector2d& m) { return Vector3d(m.x(), m.y(), 1.0).normalized(); }

/// Where a point without distortion is seen by a pinhole with these errors, on the plane z = 1 of
/// one without.
Vector2d seenBy(const CameraIntrinsics& e, const Vector2d& m) {
  const double r2 = m.squaredNorm();
  const Vector2d distorted = m * (1.0 + e(4) * r2 + e(5) * r2 * r2);
  return {(1.0 + e(0)) * distorted.x() + e(2), (1.0 + e(1)) * distorted.y() + e(3)};
}

TEST(BearingCorrection, UndoesThePinholesErrorsToFirstOrder) {
  CameraIntrinsics errors;
  errors << 0.01, -0.008, 0.004, -0.006, 0.03, -0.02;
  for (const Vector2d& m : {Vector2d(0.3, -0.2), Vector2d(-0.7, 0.5), Vector2d(0.0, 0.0)}) {
    const auto left = [&](double size) {
      const Vector3d seen = bearingAt(seenBy(size * errors, m));
      const Vector3d corrected = seen + bearingCorrectionJacobian(seen) * (size * errors);
      return (corrected.normalized() - bearingAt(m)).norm();
    };
    EXPECT_LT(left(1.0), 1e-3);
    EXPECT_NEAR(left(0.1) / left(1.0), 0.01, 0.004);
  }
}

TEST(BearingCorrection, IsTangentToTheSphereAndEndsFarFromTheAxis) {
  const Vector3d bearing = bearingAt({0.4, -0.6});
  EXPECT_LT((bearing.transpose() * bearingCorrectionJacobian(bearing)).norm(), 1e-12);
  EXPECT_TRUE(bearingCorrectionJacobian(Vector3d(0.99, 0.0, 0.14).normalized()).isZero(0.0));
}

}  // namespace
}  // namespace vins::estimator
