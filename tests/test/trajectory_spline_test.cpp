#include "simulation/trajectory_spline.h"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/random.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kInterval = 0.1;
constexpr Stamp kEpoch = 1700000000123456789;

/// A wild one: neighbouring control poses a decimetre and 20 degrees apart.
TrajectorySpline randomSpline() {
  Random random(3, "spline test");
  std::vector<Pose> controls = {Pose()};
  for (int j = 1; j < 40; ++j) {
    controls.push_back(controls.back() *
                       Pose(so3::exp(0.2 * random.normal3()), 0.1 * random.normal3()));
  }
  return {kEpoch, -0.5, kInterval, controls};
}

TEST(TrajectorySpline, DerivativesAgreeWithDifferencesOfThePose) {
  const TrajectorySpline spline = randomSpline();
  // Central differences: error step^2 / 6 times the third derivative (1e3 m/s^3 here), rounding
  // 1e-16 / step.
  const double step = 1e-5;
  for (double t = spline.begin() + 0.0137; t < spline.end() - 0.01; t += 0.0291) {
    const MotionState now = spline.at(t), before = spline.at(t - step), after = spline.at(t + step);
    const Vector3d v = (after.T_wb.position - before.T_wb.position) / (2.0 * step);
    const Vector3d a = (after.velocity_w - before.velocity_w) / (2.0 * step);
    const Vector3d omega =
        so3::log(before.T_wb.rotation.conjugate() * after.T_wb.rotation) / (2.0 * step);
    const Vector3d alpha = (after.angular_velocity_b - before.angular_velocity_b) / (2.0 * step);
    EXPECT_LT((now.velocity_w - v).norm(), 1e-6) << t;
    EXPECT_LT((now.acceleration_w - a).norm(), 1e-5) << t;
    EXPECT_LT((now.angular_velocity_b - omega).norm(), 1e-6) << t;
    EXPECT_LT((now.angular_acceleration_b - alpha).norm(), 1e-4) << t;
  }
}

TEST(TrajectorySpline, AccelerationsAreSmoothAcrossKnots) {
  const TrajectorySpline spline = randomSpline();
  // Second differences of the acceleration do not grow at a knot: its derivative is continuous.
  // With a spline of degree 4 they would be 1e4 times as large there.
  const double step = 1e-4;
  for (int knot = 1; knot < 30; ++knot) {
    const double t = spline.begin() + knot * kInterval;
    const MotionState now = spline.at(t), before = spline.at(t - step), after = spline.at(t + step);
    const Vector3d bend = (after.acceleration_w - now.acceleration_w) / step -
                          (now.acceleration_w - before.acceleration_w) / step;
    const Vector3d angular_bend =
        (after.angular_acceleration_b - now.angular_acceleration_b) / step -
        (now.angular_acceleration_b - before.angular_acceleration_b) / step;
    const double snap_bound = 1e5;  // [m/s^4], [rad/s^4]
    EXPECT_LT(bend.norm(), snap_bound * step) << knot;
    EXPECT_LT(angular_bend.norm(), snap_bound * step) << knot;
  }
}

TEST(TrajectorySpline, EqualControlPosesAreExactlyAtRest) {
  const Pose pose(so3::exp({0.3, -1.2, 2.0}), {1.1, 2.2, 3.3});
  const TrajectorySpline spline(0, 0.0, kInterval, std::vector<Pose>(20, pose));
  for (double t = 0.0; t <= spline.end(); t += 0.013) {
    const MotionState state = spline.at(t);
    EXPECT_EQ(state.T_wb.position, pose.position);
    EXPECT_EQ(state.velocity_w, Vector3d::Zero());
    EXPECT_EQ(state.acceleration_w, Vector3d::Zero());
    EXPECT_EQ(state.angular_velocity_b, Vector3d::Zero());
    EXPECT_EQ(state.angular_acceleration_b, Vector3d::Zero());
  }
}

TEST(TrajectorySpline, ReproducesUniformMotionAndTurning) {
  // Control poses of a screw motion: weights sum to one and reproduce straight lines.
  const Vector3d v(1.0, -0.5, 0.2), omega(0.1, 0.7, -0.4);
  std::vector<Pose> controls;
  for (int j = 0; j < 30; ++j) {
    const double t = (j - 2) * kInterval;
    controls.emplace_back(so3::exp(t * omega), t * v);
  }
  const TrajectorySpline spline(0, 0.0, kInterval, controls);
  for (double t = 0.0; t < spline.end(); t += 0.037) {
    const MotionState state = spline.at(t);
    EXPECT_LT((state.T_wb.position - t * v).norm(), 1e-13);
    EXPECT_LT((state.velocity_w - v).norm(), 1e-12);
    EXPECT_LT(so3::log(state.T_wb.rotation.conjugate() * so3::exp(t * omega)).norm(), 1e-13);
    EXPECT_LT((state.angular_velocity_b - omega).norm(), 1e-12);
    EXPECT_LT(state.angular_acceleration_b.norm(), 1e-10);
  }
}

TEST(TrajectorySpline, KnowsItsSpanAndItsClock) {
  const TrajectorySpline spline = randomSpline();
  EXPECT_NEAR(spline.end(), -0.5 + 35 * kInterval, 1e-12);
  EXPECT_NO_THROW(spline.at(spline.begin()));
  EXPECT_NO_THROW(spline.at(spline.end()));
  EXPECT_THROW(spline.at(spline.begin() - 0.001), InputError);
  EXPECT_THROW(spline.at(spline.end() + 0.001), InputError);
  EXPECT_THROW(spline.at(NAN), InputError);
  EXPECT_THROW(TrajectorySpline(0, 0.0, kInterval, std::vector<Pose>(5)), InputError);
  EXPECT_THROW(TrajectorySpline(0, 0.0, 0.0, std::vector<Pose>(9)), InputError);
  EXPECT_DOUBLE_EQ(spline.secondsAt(kEpoch + 1500000000), 1.5);
  EXPECT_DOUBLE_EQ(spline.shiftedBy(250000000).secondsAt(kEpoch + 1500000000), 1.25);
}

}  // namespace
}  // namespace vins::simulation
