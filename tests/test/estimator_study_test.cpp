// What the estimator must be good for, on flights without images (see simulation/odometry_study.h).

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/odometry_study.h"
#include "simulation/parallel_for.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

OdometryStudyOptions flight(const char* trajectory, double seconds) {
  OdometryStudyOptions options;
  options.trajectory = trajectory;
  options.features.duration = seconds;
  options.features.max_features = 100;
  return options;
}

TEST(EstimatorStudy, FindsATimeOffsetOfThirtyMilliseconds) {
  OdometryStudyOptions options = flight("hall_loop", 25.0);
  options.time_offset = 0.03;
  options.estimator.estimate_td = true;
  const OdometryFigures figures = evaluate(runOdometry(options, 1));
  ASSERT_TRUE(figures.initialised);
  EXPECT_LT(figures.td_error, 1e-3);
  EXPECT_LT(std::abs(figures.scale_error), 0.02);
}

TEST(EstimatorStudy, CorrectsAnExtrinsicThatIsFiveDegreesOff) {
  OdometryStudyOptions options = flight("hall_loop", 25.0);
  options.estimator.extrinsic = estimator::ExtrinsicMode::kRefined;
  options.estimator.T_bc.rotation =
      options.T_bc.rotation *
      so3::exp(5.0 * kDegree * Eigen::Vector3d(1.0, -1.0, 1.0).normalized());
  const OdometryFigures figures = evaluate(runOdometry(options, 1));
  ASSERT_TRUE(figures.initialised);
  EXPECT_LT(figures.extrinsic_rotation_error, 0.3 * kDegree);
  EXPECT_LT(figures.extrinsic_translation_error, 0.02);
}

TEST(EstimatorStudy, FindsTheReadoutOfARollingShutter) {
  OdometryStudyOptions options = flight("hall_loop", 25.0);
  options.features.readout = 0.02;
  options.estimator.estimate_readout = true;
  options.estimator.estimate_td = true;
  const OdometryRun run = runOdometry(options, 1);
  ASSERT_TRUE(evaluate(run).initialised);
  EXPECT_NEAR(run.rig.readout, 0.02, 1e-3);
  const double known = std::sqrt(run.rig_covariance(estimator::kReadout, estimator::kReadout));
  EXPECT_LT(known, 1e-3);
  EXPECT_NEAR(run.rig.td, 0.0, 1e-3);
}

TEST(EstimatorStudy, LeavesIntrinsicsThatAreRightWhereTheyAre) {
  OdometryStudyOptions options = flight("hall_loop", 25.0);
  options.estimator.estimate_intrinsics = true;
  options.estimator.estimate_imu_intrinsics = true;
  const OdometryRun run = runOdometry(options, 1);
  ASSERT_TRUE(evaluate(run).initialised);
  const estimator::RigVector error = minus(run.rig, run.true_rig);
  for (int i = estimator::kIntrinsics; i < estimator::kRigSize; ++i) {
    EXPECT_LT(std::abs(error(i)), 4.0 * std::sqrt(run.rig_covariance(i, i))) << i;
  }
  EXPECT_LT(error.segment<2>(estimator::kIntrinsics).norm(), 3e-3);
}

TEST(EstimatorStudy, FindsAnUnknownExtrinsic) {
  OdometryStudyOptions options = flight("hall_loop", 30.0);
  options.estimator.extrinsic = estimator::ExtrinsicMode::kUnknown;
  options.estimator.T_bc = Pose();
  const OdometryFigures figures = evaluate(runOdometry(options, 2));
  ASSERT_TRUE(figures.initialised);
  EXPECT_LT(figures.extrinsic_rotation_error, 0.3 * kDegree);
  EXPECT_LT(figures.extrinsic_translation_error, 0.02);
}

TEST(EstimatorStudy, LeavesTheRigAloneWhereNothingShowsIt) {
  OdometryStudyOptions options = flight("still", 15.0);
  options.estimator.extrinsic = estimator::ExtrinsicMode::kRefined;
  options.estimator.estimate_td = true;
  const OdometryRun run = runOdometry(options, 1);
  const OdometryFigures figures = evaluate(run);
  ASSERT_TRUE(figures.initialised);
  // At rest no calibration shows: what moves it is noise, to be far below what is not known of it.
  EXPECT_LT(figures.td_error, 0.1 * options.estimator.td_sigma);
  EXPECT_LT(figures.extrinsic_rotation_error, 0.1 * options.estimator.extrinsic_rotation_sigma);
  EXPECT_GT(std::sqrt(run.rig_covariance(6, 6)), 0.9 * options.estimator.td_sigma);
}

TEST(EstimatorStudy, RestsWithoutDrift) {
  OdometryStudyOptions options = flight("still", 60.0);
  options.features.loss_probability = 0.002;  // of a camera that stands still
  const OdometryRun run = runOdometry(options, 1);
  ASSERT_FALSE(run.samples.empty());
  EXPECT_LT(toSeconds(run.samples.front().estimate.stamp - run.begin), 1.0);
  const Pose first = run.samples.front().estimate.state.T_wb;
  double furthest = 0.0, widest = 0.0;
  for (const OdometrySample& sample : run.samples) {
    const Pose& T_wb = sample.estimate.state.T_wb;
    furthest = std::max(furthest, (T_wb.position - first.position).norm());
    widest = std::max(widest, T_wb.rotation.angularDistance(first.rotation));
  }
  EXPECT_LT(furthest, 0.01);
  EXPECT_LT(widest, 0.1 * kDegree);
}

/// Largest distance from the first position in the fifteen seconds of turning that a flight of
/// pure_rotation begins with [m].
double wanderingWhileTurning(const OdometryRun& run) {
  double furthest = 0.0;
  for (const OdometrySample& sample : run.samples) {
    if (toSeconds(sample.estimate.stamp - run.begin) > 15.0) break;
    const Pose moved =
        run.samples.front().estimate.state.T_wb.inverse() * sample.estimate.state.T_wb;
    const Pose truth = run.samples.front().truth.T_wb.inverse() * sample.truth.T_wb;
    furthest = std::max(furthest, (moved.position - truth.position).norm());
  }
  return furthest;
}

TEST(EstimatorStudy, InventsNoPositionWhileTheRigOnlyTurns) {
  int turned = 0;
  for (const std::uint64_t seed : {1, 2, 4, 5}) {
    const OdometryRun run = runOdometry(flight("pure_rotation", 30.0), seed);
    ASSERT_FALSE(run.samples.empty());
    // It may start later: without translation only a rest tells the velocity.
    turned += toSeconds(run.samples.front().estimate.stamp - run.begin) < 2.0;
    EXPECT_LT(wanderingWhileTurning(run), 0.05) << "seed " << seed;
    EXPECT_LT(std::abs(evaluate(run).scale_error), 0.02) << "seed " << seed;
  }
  EXPECT_GE(turned, 2) << "too few flights show it";
}

TEST(EstimatorStudy, MotionOnlyAdjustmentIsNearlyAsGood) {
  OdometryStudyOptions options = flight("hall_loop", 20.0);
  const OdometryFigures full = evaluate(runOdometry(options, 4));
  options.estimator.motion_only = estimator::MotionOnly::kAlways;
  const OdometryFigures fast = evaluate(runOdometry(options, 4));
  ASSERT_TRUE(full.initialised && fast.initialised);
  EXPECT_LT(fast.ate, 3.0 * full.ate + 0.01);
  EXPECT_EQ(fast.completeness, full.completeness);
  // Its covariance leaves information out: it must not promise more than the window's.
  EXPECT_LT(fast.nees.pose, 2.0);
}

/// Average NEES of many short flights.
Consistency consistency(bool first_estimates, int seeds) {
  OdometryStudyOptions options = flight("hall_loop", 12.0);
  options.estimator.first_estimates = first_estimates;
  std::vector<OdometryFigures> figures(static_cast<std::size_t>(seeds));
  parallelFor(seeds, 2, [&](int seed) {
    figures[static_cast<std::size_t>(seed)] =
        evaluate(runOdometry(options, static_cast<std::uint64_t>(seed) + 1));
  });
  const OdometryAverages averages = average(figures);
  EXPECT_EQ(averages.initialised, figures.size());
  return averages.mean.nees;
}

TEST(EstimatorStudy, TheCovarianceIsHonestOverFiftyRuns) {
  const Consistency nees = consistency(true, 50);
  for (const double value : {nees.position, nees.rotation, nees.pose, nees.velocity,
                             nees.accelerometer_bias, nees.gyroscope_bias}) {
    EXPECT_GT(value, 0.5);
    EXPECT_LT(value, 2.0);
  }
}

}  // namespace
}  // namespace vins::simulation
