#include "vins_estimator/visual/rolling_shutter.h"

#include <gtest/gtest.h>

#include "vins_core/pose.h"
#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

constexpr double kFocal = 460.0;
constexpr double kCentre = 240.0;

/// A camera that turns and flies at constant rates, and what it sees row by row.
struct Flight {
  Vector3d rate_b{0.6, -0.9, 0.4};     // [rad/s]
  Vector3d velocity_b{0.8, 0.5, 0.3};  // [m/s], in the frame at time zero
  Pose T_bc{so3::exp(Vector3d(0.1, 0.2, -1.4)), Vector3d::Zero()};

  Pose cameraAt(double t) const { return Pose(so3::exp(t * rate_b), t * velocity_b) * T_bc; }
  Vector3d bearingAt(double t, const Vector3d& p) const {
    return (cameraAt(t).inverse() * p).normalized();
  }
  static double rowOf(const Vector3d& bearing) {
    return kCentre + kFocal * bearing.y() / bearing.z();
  }
  /// When the shutter that starts at zero comes by.
  double seenAt(const Vector3d& p, const RollingShutter& shutter) const {
    double t = 0.0;
    for (int i = 0; i < 50; ++i) t = shutter.rowTime(rowOf(bearingAt(t, p)));
    return t;
  }
};

TEST(RollingShutter, BringsFeaturesToTheTimeOfTheFirstRow) {
  const Flight flight;
  const RollingShutter shutter{0.02, 480, flight.T_bc.rotation};
  std::vector<ImuSample> gyro;
  for (int k = 0; k <= 4; ++k) gyro.push_back({k * 5'000'000, Vector3d::Zero(), flight.rate_b});
  FeatureFrame frame;
  std::vector<Vector3d> truth;
  double worst_before = 0.0;
  for (int i = 0; i < 25; ++i) {
    const Vector3d p = flight.T_bc * Vector3d(-1.0 + 0.5 * (i % 5), -1.0 + 0.5 * (i / 5), 3.0);
    const double t = flight.seenAt(p, shutter);
    FeatureObservation feature;
    feature.id = i;
    feature.track_length = 5;
    feature.bearing = flight.bearingAt(t, p);
    feature.pixel = {0.0, Flight::rowOf(feature.bearing)};
    feature.bearing_velocity =
        (flight.bearingAt(t + 1e-4, p) - flight.bearingAt(t - 1e-4, p)) / 2e-4;
    truth.push_back(flight.bearingAt(0.0, p));
    worst_before = std::max(worst_before, (feature.bearing - truth.back()).norm());
    frame.observations.push_back(feature);
  }
  const FeatureFrame corrected = atFirstRow(frame, shutter, gyro, flight.rate_b);
  ASSERT_EQ(corrected.observations.size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) {
    const double error = (corrected.observations[i].bearing - truth[i]).norm();
    // Second order of what happens in 20 ms: a few percent of the shift.
    EXPECT_LT(error * kFocal, 0.3);
  }
  EXPECT_GT(worst_before * kFocal, 5.0);
}

TEST(RollingShutter, LeavesOutWhatHasNoVelocity) {
  FeatureFrame frame;
  frame.observations.resize(2);
  frame.observations[1].track_length = 2;
  const RollingShutter shutter{0.02, 480, Eigen::Quaterniond::Identity()};
  EXPECT_EQ(atFirstRow(frame, shutter, {}, Vector3d::Zero()).observations.size(), 1u);
}

}  // namespace
}  // namespace vins::estimator
