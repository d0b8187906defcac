#include "simulation/odometry_figures.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "simulation/random.h"
#include "vins_core/parameters.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

Pose yawAndPosition(double yaw, const Vector3d& position) {
  return {so3::exp(yaw * Vector3d::UnitZ()), position};
}

Pose truePose(double t) {
  return {so3::exp({0.1 * std::sin(t), 0.2 * std::cos(0.7 * t), 0.3 * t}),
          {2.0 * std::cos(0.5 * t), 1.5 * std::sin(0.5 * t), 1.0 + 0.3 * std::sin(t)}};
}

/// 20 s of estimates that lie in a world moved by `T_estimate_truth`, with errors drawn from the
/// covariance that they state.
OdometryRun makeRun(const Pose& T_estimate_truth, double deviation, std::uint64_t seed,
                    double scale = 1.0) {
  Random random(seed, "errors");
  OdometryRun run;
  run.seed = seed;
  run.frames = 420;
  for (int i = 20; i < 420; ++i) {
    const double t = 0.05 * i;
    OdometrySample sample;
    sample.truth.T_wb = truePose(t);
    sample.truth.v_w = Vector3d(std::sin(t), 0.0, 1.0);
    sample.estimate.stamp = toNanoseconds(t);
    estimator::NavState state = sample.truth;
    state.T_wb = T_estimate_truth * state.T_wb;
    state.v_w = T_estimate_truth.rotation * state.v_w;
    state.T_wb.position *= scale;
    estimator::Vector15d error;
    for (int k = 0; k < 15; ++k) error[k] = deviation * random.normal();
    sample.estimate.state = plus(state, error);
    sample.estimate.covariance = deviation * deviation * estimator::Matrix15d::Identity();
    if (i == 20) sample.gauge = Gauge{state.T_wb, sample.truth.T_wb};
    run.samples.push_back(sample);
    run.frame_seconds.push_back(1e-3 * (i % 100));
  }
  return run;
}

TEST(OdometryFigures, AlignmentFindsPositionAndYaw) {
  const Pose T = yawAndPosition(2.5, {1.0, -2.0, 3.0});
  std::vector<Vector3d> estimated, truth;
  for (double t = 0.0; t < 5.0; t += 0.1) {
    estimated.push_back(truePose(t).position);
    truth.push_back(T * truePose(t).position);
  }
  const Pose found = alignPositionAndYaw(estimated, truth);
  EXPECT_LT(so3::log(found.rotation.conjugate() * T.rotation).norm(), 1e-12);
  EXPECT_LT((found.position - T.position).norm(), 1e-12);
  const Pose of_one = alignPositionAndYaw(truePose(3.0), T * truePose(3.0));
  EXPECT_LT(so3::log(of_one.rotation.conjugate() * T.rotation).norm(), 1e-12);
  EXPECT_LT((of_one.position - T.position).norm(), 1e-12);
}

TEST(OdometryFigures, AlignmentIsTheLeastSquares) {
  Random random(3, "noise");
  std::vector<Vector3d> estimated, truth;
  for (double t = 0.0; t < 5.0; t += 0.1) {
    estimated.push_back(truePose(t).position + 0.1 * random.normal3());
    truth.push_back(truePose(t).position);
  }
  const auto cost = [&](const Pose& T) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      sum += (T * estimated[i] - truth[i]).squaredNorm();
    return sum;
  };
  const Pose best = alignPositionAndYaw(estimated, truth);
  for (const double step : {-0.01, 0.01}) {
    Pose turned = best;
    turned.rotation = so3::exp(step * Vector3d::UnitZ()) * turned.rotation;
    EXPECT_GT(cost(turned), cost(best));
    for (int axis = 0; axis < 3; ++axis) {
      Pose moved = best;
      moved.position[axis] += step;
      EXPECT_GT(cost(moved), cost(best));
    }
  }
}

TEST(OdometryFigures, ScaleErrorIsPositiveWhereTheEstimateIsTooLarge) {
  std::vector<Vector3d> estimated, truth, still(100, Vector3d(1.0, 2.0, 3.0));
  for (int i = 0; i < 100; ++i) {
    truth.push_back(truePose(0.1 * i).position);
    estimated.push_back(yawAndPosition(1.0, {1, 2, 3}) * Vector3d(1.03 * truth.back()));
  }
  EXPECT_NEAR(scaleError(estimated, truth).value(), 0.03, 1e-12);
  EXPECT_FALSE(scaleError(estimated, still));
}

TEST(OdometryFigures, NeesIsOneWhereTheErrorsAreAsStatedWhateverTheWorld) {
  for (const double yaw : {0.0, 2.0}) {
    const Pose T = yawAndPosition(yaw, {10.0, -5.0, 1.0});
    const OdometryFigures figures = evaluate(makeRun(T, 0.01, 1));
    // 400 samples of 3 degrees of freedom: a deviation of sqrt(2 / 1200) = 0.04.
    EXPECT_NEAR(figures.nees.position, 1.0, 0.16);
    EXPECT_NEAR(figures.nees.rotation, 1.0, 0.16);
    EXPECT_NEAR(figures.nees.pose, 1.0, 0.12);
    EXPECT_NEAR(figures.nees.velocity, 1.0, 0.16);
    EXPECT_NEAR(figures.nees.accelerometer_bias, 1.0, 0.16);
    EXPECT_NEAR(figures.nees.gyroscope_bias, 1.0, 0.16);
    EXPECT_EQ(figures.uncovered, 0.0);
    EXPECT_NEAR(figures.ate, 0.01 * std::sqrt(3.0), 0.002);
    EXPECT_NEAR(figures.rotation_error, 0.01 * std::sqrt(3.0), 0.002);
    EXPECT_LT(figures.drift, 0.06);
  }
}

TEST(OdometryFigures, FiguresTellWhatHappened) {
  OdometryRun run = makeRun({}, 1e-6, 1, 1.02);
  OdometryFigures figures = evaluate(run);
  EXPECT_TRUE(figures.initialised);
  EXPECT_NEAR(figures.time_to_initialise, 1.0, 1e-9);
  EXPECT_NEAR(figures.completeness, 400.0 / 420.0, 1e-12);
  EXPECT_NEAR(figures.scale_error, 0.02, 1e-4);
  EXPECT_NEAR(figures.early_scale_error.value(), 0.02, 1e-4);
  EXPECT_NEAR(figures.mean_ms, 49.5, 1e-9);
  EXPECT_NEAR(figures.p95_ms, 94.0, 1.0);
  EXPECT_EQ(figures.resets, 0.0);
  run.samples[300].estimate.covariance.setZero();
  run.samples.back().estimate.sequence = 2;
  figures = evaluate(run);
  EXPECT_NEAR(figures.uncovered, 1.0 / 400.0, 1e-12);
  EXPECT_EQ(figures.resets, 2.0);
}

TEST(OdometryFigures, ARunAtRestIsAlignedByItsFirstPose) {
  OdometryRun run = makeRun(yawAndPosition(2.0, {1.0, 2.0, 3.0}), 1e-6, 1);
  run.samples.resize(1);
  const OdometryFigures figures = evaluate(run);
  EXPECT_LT(figures.rotation_error, 1e-4);
  EXPECT_LT(figures.ate, 1e-4);
  EXPECT_FALSE(figures.early_scale_error);
}

TEST(OdometryFigures, RunsThatNeverStartedAreCountedAndLeftOut) {
  OdometryRun failed;
  failed.seed = 7;
  failed.frames = 100;
  const std::vector<OdometryFigures> all = {evaluate(failed), evaluate(makeRun({}, 0.01, 2, 0.95)),
                                            evaluate(makeRun({}, 0.01, 3, 1.05))};
  const OdometryAverages averages = average(all);
  EXPECT_EQ(averages.runs, 3u);
  EXPECT_EQ(averages.initialised, 2u);
  EXPECT_NEAR(averages.mean.completeness, 2.0 / 3.0 * 400.0 / 420.0, 1e-12);
  EXPECT_NEAR(averages.mean.time_to_initialise, 1.0, 1e-9);
  // By size: they must not cancel.
  EXPECT_NEAR(averages.mean.scale_error, 0.05, 0.002);
  EXPECT_NEAR(averages.worst_scale_error, 0.05, 0.002);
  std::ostringstream table;
  printTable(table, all);
  EXPECT_NE(table.str().find("2 of 3 runs initialised"), std::string::npos) << table.str();
  const Parameters json = Parameters::parse(toJson(all), "json");
  EXPECT_NEAR(json.section("mean").number("ate_m"), averages.mean.ate, 1e-6);
}

}  // namespace
}  // namespace vins::simulation
