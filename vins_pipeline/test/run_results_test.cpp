#include "vins_pipeline/run_results.h"

#include <sstream>

#include <gtest/gtest.h>

#include "vins_core/trajectory_file.h"

namespace vins::pipeline {
namespace {

constexpr Stamp kStart = 1600000000000000000;

PipelineResult resultAt(int i, bool is_tracking, std::uint32_t sequence = 0) {
  PipelineResult result;
  result.stamp = kStart + i * 50'000'000;
  result.frame.emplace().observations.resize(100 + i);
  estimator::EstimatorResult estimate;
  estimate.stamp = result.stamp;
  if (is_tracking) {
    estimate.status = estimator::EstimatorStatus::kTracking;
    estimate.odometry.emplace();
    estimate.odometry->stamp = result.stamp;
    estimate.odometry->sequence = sequence;
    estimate.odometry->state.T_wb.position = {0.1 * i, 0.0, 1.0};
    estimate.odometry->state.v_w = {2.0, 0.0, 0.0};
  }
  result.estimates.push_back(estimate);
  return result;
}

TEST(RunResults, WritesBothForms) {
  RunResults results;
  for (int i = 0; i < 10; ++i) results.add(resultAt(i, i >= 4));
  EXPECT_EQ(results.images(), 10u);
  EXPECT_EQ(results.frames(), 10u);
  EXPECT_EQ(results.odometries(), 6u);
  EXPECT_NEAR(results.initialisedAfter().value(), 0.2, 1e-9);
  EXPECT_TRUE(results.isTracking());
  EXPECT_NEAR(results.pathLength(), 0.5, 1e-9);
  EXPECT_EQ(results.resets(), 0u);
  for (const std::string& text : {results.vioLive(), results.vinsMonoCsv()}) {
    std::istringstream in(text);
    const Trajectory trajectory = readTrajectory(in, "written");
    ASSERT_EQ(trajectory.poses().size(), 6u);
    EXPECT_EQ(trajectory.poses()[1].stamp, kStart + 250'000'000);
    EXPECT_NEAR(trajectory.poses()[1].T_wb.position.x(), 0.5, 1e-9);
  }
  EXPECT_EQ(results.vinsMonoCsv().substr(0, results.vinsMonoCsv().find('\n')),
            "1600000000200000000,0.400000000,0.000000000,1.000000000,1.000000000,0.000000000,"
            "0.000000000,0.000000000,2.000000000,0.000000000,0.000000000,");
}

TEST(RunResults, NothingIsInitialisedWithoutOdometry) {
  RunResults results;
  EXPECT_FALSE(results.isTracking());
  results.add(resultAt(0, false));
  EXPECT_FALSE(results.initialisedAfter());
  EXPECT_FALSE(results.isTracking());
  EXPECT_TRUE(results.vioLive().empty());
}

TEST(RunResults, CountsResetsAndLosses) {
  RunResults results;
  results.add(resultAt(0, true, 0));
  results.add(resultAt(1, true, 0));
  results.add(resultAt(2, false));
  EXPECT_FALSE(results.isTracking());
  // The new sequence has a world of its own: the jump is no path.
  results.add(resultAt(30, true, 1));
  EXPECT_TRUE(results.isTracking());
  EXPECT_EQ(results.resets(), 1u);
  EXPECT_NEAR(results.pathLength(), 0.1, 1e-9);
}

TEST(RunResults, TruthIsWrittenInRisingOrderWithWhatIsKnown) {
  const Pose T(Eigen::Quaterniond::Identity(), {1.0, 2.0, 3.0});
  RunResults poses, positions;
  for (const Stamp stamp : {kStart, kStart, kStart + 5, kStart + 3}) {
    poses.add(RecordedTruth{stamp, T, true});
    positions.add(RecordedTruth{stamp, T, false});
  }
  std::istringstream in(poses.groundTruth());
  EXPECT_EQ(readTrajectory(in, "truth").poses().size(), 2u);
  EXPECT_EQ(positions.groundTruth(),
            "1600000000.000000000 1.000000000 2.000000000 3.000000000\n"
            "1600000000.000000005 1.000000000 2.000000000 3.000000000\n");
}

TEST(RunResults, ComparesAtTheImusTime) {
  RunResults results;
  PipelineResult result = resultAt(0, true);
  results.add(result);
  const std::vector<StampedPose> poses = {{result.estimates[0].odometry->stamp, Pose()}};
  EXPECT_FALSE(results.atImuTime(Trajectory(poses))) << "one clock already";
  result.estimates[0].rig.td = 0.2;
  results.add(result);
  const std::optional<Trajectory> shifted = results.atImuTime(Trajectory(poses));
  ASSERT_TRUE(shifted);
  EXPECT_EQ(shifted->poses().at(0).stamp, poses[0].stamp + 200'000'000);
}

TEST(RunResults, CountsWarningsByCode) {
  RunResults results;
  PipelineResult result = resultAt(0, true);
  result.events = {{0, Severity::kWarning, "imu_gap", "", {}},
                   {0, Severity::kInfo, "initialised", "", {}},
                   {0, Severity::kWarning, "imu_gap", "", {}}};
  results.add(result);
  EXPECT_EQ(results.warnings().size(), 1u);
  EXPECT_EQ(results.warnings().at("imu_gap"), 2u);
  EXPECT_EQ(results.state().substr(0, 13), "100 features,");
}

}  // namespace
}  // namespace vins::pipeline
