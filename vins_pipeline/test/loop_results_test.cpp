#include "vins_pipeline/loop_results.h"

#include <sstream>

#include <gtest/gtest.h>

#include "vins_core/heading.h"
#include "vins_core/trajectory_file.h"

namespace vins::pipeline {
namespace {

constexpr Stamp kSecond = 1'000'000'000;

Pose poseAt(double x) { return {yawRotation(0.1 * x), {x, 0.0, 1.0}}; }

PipelineResult frameAt(Stamp stamp, std::uint32_t sequence, double x) {
  estimator::Odometry odometry;
  odometry.stamp = stamp;
  odometry.sequence = sequence;
  odometry.state.T_wb = poseAt(x);
  estimator::EstimatorResult estimate;
  estimate.odometry = odometry;
  PipelineResult result;
  result.estimates = {estimate};
  result.corrected = {{stamp, poseAt(x + 100.0)}};
  return result;
}

pose_graph::KeyframeVertex keyframeAt(Stamp stamp, double x, const Pose& T_mw) {
  return {stamp, 0, stamp, poseAt(x), T_mw * poseAt(x)};
}

Trajectory parse(const std::string& text) {
  std::istringstream in(text);
  return readTrajectory(in, "test");
}

// Nine decimals are written.
constexpr double kDigits = 1e-8;

double distance(const Pose& a, const Pose& b) {
  return (a.position - b.position).norm() + a.rotation.angularDistance(b.rotation);
}

class LoopResultsTest : public ::testing::Test {
 protected:
  LoopResultsTest() {
    for (int i = 1; i <= 5; ++i) results_.add(frameAt(i * kSecond, 0, i));
    results_.add(frameAt(6 * kSecond, 1, 6.0));
    paths_ = {{0, true, {keyframeAt(2 * kSecond, 2, first_), keyframeAt(4 * kSecond, 4, second_)}}};
  }

  const Pose first_{yawRotation(0.3), {1.0, 2.0, 3.0}};
  const Pose second_{yawRotation(-0.4), {-1.0, 0.5, 0.0}};
  LoopResults results_;
  std::vector<pose_graph::SequencePath> paths_;
};

TEST_F(LoopResultsTest, LiveIsWhatWasKnownThen) {
  const Trajectory live = parse(results_.live());
  ASSERT_EQ(live.poses().size(), 6u);
  EXPECT_EQ(live.poses()[2].stamp, 3 * kSecond);
  EXPECT_LT(distance(live.poses()[2].T_wb, poseAt(103.0)), kDigits);
}

TEST_F(LoopResultsTest, FinallyAFrameMovesWithTheKeyframeBeforeIt) {
  const Trajectory path = parse(results_.finalPath(paths_));
  ASSERT_EQ(path.poses().size(), 6u);
  // The first frame has no keyframe before it; the last one's sequence has none at all.
  const Pose drifts[] = {first_, first_, first_, second_, second_, Pose()};
  for (std::size_t i = 0; i < 6; ++i) {
    const Pose expected = drifts[i] * poseAt(static_cast<double>(i) + 1.0);
    EXPECT_LT(distance(path.poses()[i].T_wb, expected), kDigits) << i;
  }
}

TEST_F(LoopResultsTest, KeyframesAreWrittenInTheFormOfVinsMono) {
  paths_[0].keyframes.resize(1);
  paths_[0].keyframes[0].T_mb = Pose({1.0, 0.0, 0.0, 0.0}, {1.5, -2.0, 0.25});
  EXPECT_EQ(LoopResults::vinsMonoCsv(paths_),
            "2000000000,1.500000000,-2.000000000,0.250000000,1.000000000,0.000000000,0.000000000,"
            "0.000000000,\n");
  // Keyframes of a loaded map are none of this run.
  const std::string own = LoopResults::vinsMonoCsv(paths_);
  paths_.insert(paths_.begin(), {-1, true, {keyframeAt(kSecond, 1, first_)}});
  EXPECT_EQ(LoopResults::vinsMonoCsv(paths_), own);
}

}  // namespace
}  // namespace vins::pipeline
