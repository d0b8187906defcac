#include "simulation/spline_fit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "simulation/builtin_trajectories.h"
#include "simulation/random.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/testing/shared_data.h"
#include "vins_core/trajectory_file.h"

namespace vins::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// Poses of a flight at 200 Hz, with noise.
Trajectory record(const TrajectorySpline& truth, double duration, double noise_m,
                  double noise_rad) {
  Random random(5, "spline fit test");
  Trajectory trajectory;
  for (int i = 0; i <= static_cast<int>(200.0 * duration); ++i) {
    Pose T_wb = truth.poseAt(0.005 * i);
    T_wb.position += noise_m * random.normal3();
    T_wb.rotation = T_wb.rotation * so3::exp(noise_rad * random.normal3());
    trajectory.append({truth.epoch() + Stamp{5000000} * i, T_wb});
  }
  return trajectory;
}

/// Largest differences of two motions: position [m], rotation [rad], acceleration [m/s^2].
struct Difference {
  double position = 0.0, rotation = 0.0, acceleration = 0.0;
};

Difference compare(const TrajectorySpline& a, const TrajectorySpline& b, double from, double to) {
  Difference most;
  for (double t = from; t < to; t += 0.0031) {
    const MotionState x = a.at(t), y = b.at(t);
    most.position = std::max(most.position, (x.T_wb.position - y.T_wb.position).norm());
    most.rotation =
        std::max(most.rotation, so3::log(x.T_wb.rotation.conjugate() * y.T_wb.rotation).norm());
    most.acceleration = std::max(most.acceleration, (x.acceleration_w - y.acceleration_w).norm());
  }
  return most;
}

TEST(SplineFit, FollowsAnExactRecording) {
  const TrajectorySpline truth = makeBuiltinTrajectory("fast", 1, 10.0);
  const SplineFit fit = fitSpline(record(truth, 10.0, 0.0, 0.0));
  EXPECT_LT(fit.position_max, 1e-4);
  EXPECT_LT(fit.rotation_max, 0.001 * kDegree);
  const Difference most = compare(fit.spline, truth, 0.0, 10.0);
  EXPECT_LT(most.position, 1e-4);
  EXPECT_LT(most.rotation, 0.001 * kDegree);
}

TEST(SplineFit, DoesNotTurnNoiseIntoWildAccelerations) {
  const TrajectorySpline truth = makeBuiltinTrajectory("hall_loop", 1, 20.0);
  const SplineFit fit = fitSpline(record(truth, 20.0, 1e-3, 5e-4));
  EXPECT_NEAR(fit.position_rms, std::sqrt(3.0) * 1e-3, 2e-4);
  const Difference most = compare(fit.spline, truth, 0.5, 19.5);
  EXPECT_LT(most.position, 1.5e-3);
  // The noise twice differentiated at 200 Hz would be 1e-3 sqrt(6) / 0.005^2 = 98 m/s^2.
  EXPECT_LT(most.acceleration, 1.5);
}

TEST(SplineFit, BridgesAGap) {
  const TrajectorySpline truth = makeBuiltinTrajectory("hall_loop", 1, 20.0);
  const Trajectory whole = record(truth, 20.0, 0.0, 0.0);
  Trajectory holed;
  for (const StampedPose& pose : whole.poses()) {
    const double t = toSeconds(pose.stamp);
    if (t < 10.0 || t > 10.3) holed.append(pose);
  }
  const Difference most = compare(fitSpline(holed).spline, truth, 9.9, 10.4);
  // A flight's jerk of some 10 m/s^3 over 0.15 s to either side.
  EXPECT_LT(most.position, 0.01);
  EXPECT_LT(most.rotation, 1.0 * kDegree);
}

TEST(SplineFit, ReachesBeyondBothEndsByItsMargin) {
  const SplineFit fit =
      fitSpline(record(makeBuiltinTrajectory("figure_eight", 1, 5.0), 5.0, 0.0, 0.0));
  EXPECT_LE(fit.spline.begin(), -0.1);
  EXPECT_GE(fit.spline.end(), 5.1);
}

TEST(SplineFit, RefusesWhatCannotBeFitted) {
  EXPECT_THROW(fitSpline(Trajectory()), InputError);
  SplineFitOptions options;
  options.knot_interval = 0.0;
  EXPECT_THROW(options.validate(), InputError);
}

/// Ground truth of EuRoC: file, bounds of residuals (root mean square [mm], [deg]; largest). The
/// ground truth of MH_05 itself jumps three times, by up to 6 cm from one pose to the next.
class RealGroundTruth
    : public ::testing::TestWithParam<std::tuple<const char*, double, double, double, double>> {};

TEST_P(RealGroundTruth, IsFollowedWithPlausibleAccelerations) {
  const auto [name, rms_mm, max_mm, rms_degrees, max_degrees] = GetParam();
  const std::string path = vins::testing::sharedData(name);
  VINS_SKIP_WITHOUT(path);
  const Trajectory trajectory = readTrajectoryFile(path);
  const SplineFit fit = fitSpline(trajectory);
  EXPECT_LT(1e3 * fit.position_rms, rms_mm) << fit;
  EXPECT_LT(1e3 * fit.position_max, max_mm) << fit;
  EXPECT_LT(fit.rotation_rms, rms_degrees * kDegree) << fit;
  EXPECT_LT(fit.rotation_max, max_degrees * kDegree) << fit;
  double most = 0.0;
  for (double t = 0.0; t < trajectory.duration(); t += 0.005) {
    most = std::max(most, fit.spline.at(t).acceleration_w.norm());
  }
  EXPECT_LT(most, 15.0);  // the recorded specific force peaks at 35 m/s^2, in a shock at the end
}

INSTANTIATE_TEST_SUITE_P(
    EuRoC, RealGroundTruth,
    ::testing::Values(std::make_tuple("groundtruth/V1_01_easy.txt", 0.2, 2.0, 0.02, 0.1),
                      std::make_tuple("groundtruth/V1_03_difficult.txt", 0.2, 2.0, 0.02, 0.1),
                      std::make_tuple("groundtruth/V2_01_easy.txt", 0.2, 5.0, 0.02, 0.1),
                      std::make_tuple("groundtruth/MH_05_difficult.txt", 1.0, 30.0, 0.02, 0.3)));

}  // namespace
}  // namespace vins::simulation
