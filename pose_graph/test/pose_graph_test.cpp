#include "pose_graph/pose_graph.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "pose_graph/place/recent_images.h"
#include "pose_graph_fixture.h"
#include "synthetic_keyframes.h"
#include "vins_core/input_error.h"
#include "vins_core/pose_covariance.h"

namespace vins::pose_graph {
namespace {

using testing::difference;
using testing::kDrift;
using testing::Revisits;

// Bearings of views are single precision, and matches of identical images are exact: 1e-7 of the
// unit length, over some metres, with room for how well 25 points and more determine a pose.
constexpr double kSingle = 1e-4;

using PoseGraphTest = testing::PoseGraphFixture;

TEST_F(PoseGraphTest, ARevisitBecomesAMatchInTheQuerysWorldAndAnEvent) {
  const auto graph = this->graph();
  const std::vector<PoseGraphResult> found = fly(graph.get());
  ASSERT_GE(found.size(), 1u);
  for (const PoseGraphResult& result : found) {
    const LoopMatch& match = *result.match;
    const int place = static_cast<int>(match.query_id) - 10;
    EXPECT_EQ(match.old_id, place) << "the same place";
    EXPECT_EQ(match.query_stamp, (match.query_id + 1) * Revisits::kPeriod);
    EXPECT_LT(difference(match.T_old_query, Pose()), kSingle);
    // Both stood at one place: in the query's world the old body is where the query is.
    EXPECT_LT(difference(match.T_wb_old, kDrift * Revisits::truth(place)), kSingle);
    EXPECT_LT(difference(match.T_bc_old, revisits_.keyframe(0, place).T_bc), kSingle);
    EXPECT_GE(match.features.size(), 25u);
    ASSERT_EQ(result.events.size(), 1u);
    EXPECT_EQ(result.events[0].code, "loop_found");
    EXPECT_EQ(result.events[0].severity, Severity::kInfo);
    EXPECT_FALSE(
        graph->draw(result.search.checked.back(), revisits_.image(place), revisits_.image(place))
            .empty());
  }
  const PoseGraphStatistics statistics = graph->statistics();
  EXPECT_EQ(statistics.keyframes, 15u);
  EXPECT_EQ(statistics.found, found.size());
  EXPECT_EQ(statistics.loops, found.size());
  EXPECT_EQ(statistics.optimizations, found.size());
  EXPECT_GT(statistics.memory, 15 * 20'000u) << "views are remembered";
}

TEST_F(PoseGraphTest, AKeyframeChosenLongAfterItsImageHasNoPlace) {
  const auto graph = this->graph();
  for (int place = 0; place < 12; ++place) visit(graph.get(), place);
  Keyframe late = revisits_.keyframe(12, 2, kDrift);
  late.chosen_at = late.stamp + toNanoseconds(kLongestChoice) + 1;
  EXPECT_FALSE(graph->addKeyframe(late, revisits_.image(2)).match);
  Keyframe prompt = revisits_.keyframe(13, 3, kDrift);
  prompt.chosen_at = prompt.stamp + toNanoseconds(kLongestChoice) - 1;
  EXPECT_TRUE(graph->addKeyframe(prompt, revisits_.image(3)).match);
}

TEST_F(PoseGraphTest, TheMatchHasTheOldRollAndPitch) {
  const auto graph = this->graph();
  for (int place = 0; place < 12; ++place) visit(graph.get(), place);
  // An odometry whose gravity is off by a degree: yaw and place are taken from the loop, not that.
  const Pose tilted(so3::exp({0.017, 0.0, 0.0}), {0.1, 0.0, 0.0});
  visit(graph.get(), 2, tilted);
  const PoseGraphResult result = visit(graph.get(), 3, tilted);
  ASSERT_TRUE(result.match);
  const Eigen::Vector3d up_before =
      Revisits::truth(3).rotation.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up = result.match->T_wb_old.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((up - up_before).norm(), 1e-12) << "rounding";
  EXPECT_LT((result.match->T_wb_old.position - (tilted * Revisits::truth(3)).position).norm(),
            kSingle);
}

TEST_F(PoseGraphTest, LoopsTakeTheDriftBack) {
  // All of it came in one step, which no odometry is expected to do: loops that are exact win.
  options_.graph = testing::exactLoops();
  options_.found_position_sigma = 0.005;
  options_.found_rotation_sigma = 0.05;
  const auto graph = this->graph();
  EXPECT_LT(difference(graph->drift(0).value_or(Pose()), Pose()), 1e-12);
  ASSERT_FALSE(fly(graph.get()).empty());
  const Pose drift = graph->drift(0).value();
  const double left =
      (drift * kDrift * Revisits::truth(4).position - Revisits::truth(4).position).norm();
  const double all = (kDrift * Revisits::truth(4).position - Revisits::truth(4).position).norm();
  EXPECT_LT(left, 0.5 * all);
  EXPECT_NEAR(drift.rotation.x(), 0.0, 1e-12) << "yaw and translation only";
  EXPECT_NEAR(drift.rotation.y(), 0.0, 1e-12);
  const std::vector<SequencePath> paths = graph->paths();
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_TRUE(paths[0].in_map);
  EXPECT_LT(difference(paths[0].keyframes.back().T_mb, drift * kDrift * Revisits::truth(4)), 1e-9);
}

TEST_F(PoseGraphTest, TheRefinedEdgeReplacesTheFirst) {
  const auto graph = this->graph();
  const std::vector<PoseGraphResult> found = fly(graph.get());
  ASSERT_FALSE(found.empty());
  const std::size_t loops = graph->loops().size();
  LoopEdge edge;
  edge.query_id = found[0].match->query_id;
  edge.old_id = found[0].match->old_id;
  edge.T_old_query.position = {0.01, 0.0, 0.0};
  EXPECT_EQ(graph->addLoopEdge(edge).outcome, LoopOutcome::kReplaced);
  EXPECT_EQ(graph->loops().size(), loops);
  EXPECT_EQ(graph->loops()[0].T_old_query.position, edge.T_old_query.position);
  EXPECT_EQ(graph->statistics().refined, 1u);
  const std::size_t runs = graph->statistics().optimizations;
  edge.old_id = 999;
  EXPECT_EQ(graph->addLoopEdge(edge).outcome, LoopOutcome::kUnknownKeyframe);
  EXPECT_EQ(graph->statistics().optimizations, runs) << "nothing new to optimize";
}

TEST_F(PoseGraphTest, AnOptimizationWaitsForTheRefinedEdge) {
  options_.refines_in_window = true;
  const auto graph = this->graph();
  for (int place = 0; place < 12; ++place) visit(graph.get(), place);
  int place = 0;
  std::optional<LoopMatch> match;
  while (!match && place < 5) match = visit(graph.get(), place++, kDrift).match;
  ASSERT_TRUE(match);
  EXPECT_EQ(graph->statistics().optimizations, 0u) << "the estimator will tell more";
  LoopEdge edge;
  edge.query_id = match->query_id;
  edge.old_id = match->old_id;
  edge.T_old_query = match->T_old_query;
  EXPECT_EQ(graph->addLoopEdge(edge).outcome, LoopOutcome::kReplaced);
  EXPECT_EQ(graph->statistics().optimizations, 1u);
  match.reset();
  while (!match && place < 10) match = visit(graph.get(), place++, kDrift).match;
  ASSERT_TRUE(match);
  EXPECT_EQ(graph->statistics().optimizations, 1u);
  visit(graph.get(), place, kDrift);
  EXPECT_EQ(graph->statistics().optimizations, 2u) << "no longer than to the next keyframe";
}

TEST_F(PoseGraphTest, ALoopJoinsANewSequence) {
  const auto graph = this->graph();
  for (int place = 0; place < 12; ++place) visit(graph.get(), place);
  const Pose elsewhere(yawRotation(2.0), {30.0, 10.0, -3.0});
  int joined = 0;
  for (int place = 4; place < 7; ++place) {
    for (const Event& event : visit(graph.get(), place, elsewhere, 1).events) {
      joined += event.code == "sequence_joined" ? 1 : 0;
    }
  }
  EXPECT_EQ(joined, 1) << "by the first loop";
  ASSERT_EQ(graph->paths().size(), 2u);
  EXPECT_TRUE(graph->paths()[1].in_map);
  EXPECT_LT(difference(graph->drift(1).value() * elsewhere, Pose()), 10.0 * kSingle)
      << "ten metres away from where it is measured";
}

TEST_F(PoseGraphTest, TheMapsOdometryDoesNotJumpWhereTheEstimatorCarriesItsStateOverAReset) {
  options_.graph = testing::exactLoops();
  options_.found_position_sigma = 0.005;
  options_.found_rotation_sigma = 0.05;
  const auto graph = this->graph();
  ASSERT_FALSE(fly(graph.get()).empty());
  const Pose T_wb = kDrift * Revisits::truth(5);
  const Pose before = graph->locate(0, T_wb).pose;
  ASSERT_GT((before.position - Pose().position).norm(), 0.1) << "loops have corrected something";
  // The odometry goes on in its world, with a new sequence, at a place that nobody knows.
  visit(graph.get(), 40, kDrift, 1);
  const MapFromOdom after = graph->locate(1, T_wb);
  EXPECT_LT(difference(after.pose, before), 1e-9);
  EXPECT_LT(difference(graph->paths()[1].keyframes[0].T_mb, before * kDrift * Revisits::truth(40)),
            1e-9);
}

TEST_F(PoseGraphTest, ANewWorldBeginsWhereTheBodyWasLastSeenAndSaysThatThisIsAGuess) {
  const auto graph = this->graph();
  visit(graph.get(), 0);
  EXPECT_EQ(graph->locate(0, Revisits::truth(0)).covariance, se3::Matrix6d(se3::Matrix6d::Zero()));
  const Pose last = Revisits::truth(3);
  graph->locate(0, last);
  const Pose T_wm(yawRotation(2.0), {30.0, 10.0, -3.0});
  Keyframe keyframe = revisits_.keyframe(next_id_++, 50, T_wm, 1);
  keyframe.world = 1;
  graph->addKeyframe(keyframe, revisits_.image(50));
  const MapFromOdom begun = graph->locate(1, T_wm * last);
  EXPECT_LT(difference(begun.pose * T_wm * last, last), 1e-9);
  const se3::Matrix6d of_body =
      covarianceOfProduct(begun.pose, begun.covariance, T_wm * last, se3::Matrix6d::Zero());
  EXPECT_NEAR(of_body(0, 0), 100.0, 1e-6) << "[m^2]";
  EXPECT_NEAR(of_body(5, 5), 3.24, 1e-9) << "[rad^2]";
  EXPECT_LT(difference(graph->paths()[1].keyframes[0].T_mb, Revisits::truth(50)), 1e-9)
      << "its keyframes go with it";
  EXPECT_LT(difference(graph->locate(1, T_wm * Revisits::truth(9)).pose, begun.pose), 1e-12)
      << "it is placed once";
}

TEST_F(PoseGraphTest, ALoopJoinsASequenceThatWasCarriedOver) {
  const auto graph = this->graph();
  for (int place = 0; place < 12; ++place) visit(graph.get(), place);
  graph->locate(0, Revisits::truth(11));
  const Pose drifted(yawRotation(0.1), {0.5, -0.5, 0.2});  // while it was lost
  int joined = 0;
  for (int place = 4; place < 7; ++place) {
    for (const Event& event : visit(graph.get(), place, drifted, 1).events) {
      joined += event.code == "sequence_joined" ? 1 : 0;
    }
  }
  ASSERT_EQ(joined, 1);
  const MapFromOdom found = graph->locate(1, drifted * Revisits::truth(6));
  EXPECT_LT(difference(found.pose * drifted, Pose()), 10.0 * kSingle);
  EXPECT_GT(found.covariance(0, 0), 0.0) << "as well as a loop is measured";
}

TEST_F(PoseGraphTest, HoveringAddsNothing) {
  const auto graph = this->graph();
  visit(graph.get(), 0);
  for (int i = 0; i < 100; ++i) {
    // Sways by some centimetres, as a hand or a multirotor does.
    const Pose sway(yawRotation(0.01 * (i % 3)), {0.02 * (i % 2), 0.01 * (i % 5), 0.0});
    Keyframe keyframe = revisits_.keyframe(next_id_++, 0);
    keyframe.T_wb.position += sway.position;
    EXPECT_FALSE(graph->addKeyframe(keyframe, revisits_.image(0)).is_kept) << i;
  }
  EXPECT_EQ(graph->statistics().keyframes, 1u);
  EXPECT_EQ(graph->statistics().skipped, 100u);
  // A turn on the spot shows something new.
  Keyframe turned = revisits_.keyframe(next_id_++, 0);
  turned.T_wb.rotation = yawRotation(0.1) * turned.T_wb.rotation;
  EXPECT_TRUE(graph->addKeyframe(turned, {}).is_kept);
}

TEST_F(PoseGraphTest, SkipCountLeavesOutSoManyAfterEach) {
  options_.skip_count = 2;
  const auto graph = this->graph();
  std::vector<bool> kept;
  for (int place = 0; place < 7; ++place) kept.push_back(visit(graph.get(), place).is_kept);
  EXPECT_EQ(kept, (std::vector<bool>{true, false, false, true, false, false, true}));
}

TEST_F(PoseGraphTest, KeyframesAreBounded) {
  options_.thinning.max_keyframes = 30;
  options_.thinning.newest = 5;
  const auto graph = this->graph();
  for (int place = 0; place < 60; ++place) {
    graph->addKeyframe(revisits_.keyframe(next_id_++, place), {});
    EXPECT_LE(graph->statistics().keyframes, 30u);
  }
  EXPECT_GE(graph->statistics().removed, 30u);
}

TEST_F(PoseGraphTest, TheLastWordOnAKeyframeMovesIt) {
  const auto graph = this->graph();
  visit(graph.get(), 0);
  visit(graph.get(), 1);
  KeyframePoseUpdate update;
  update.keyframe_id = 1;
  update.T_wb = Pose({1.0, 0.0, 0.0, 0.0}, {7.0, 7.0, 7.0});
  EXPECT_TRUE(graph->update(update));
  EXPECT_EQ(graph->paths()[0].keyframes[1].T_wb.position, update.T_wb.position);
  update.keyframe_id = 44;
  EXPECT_FALSE(graph->update(update));
}

TEST_F(PoseGraphTest, AThreadGivesTheSameLoopsAndInTheEndTheSamePath) {
  const auto plain = graph();
  fly(plain.get());
  plain->finish();
  options_.threaded = true;
  const auto threaded = graph();
  next_id_ = 0;
  ASSERT_FALSE(fly(threaded.get()).empty());
  threaded->waitUntilIdle();
  threaded->finish();
  const auto expected = plain->paths()[0].keyframes, path = threaded->paths()[0].keyframes;
  ASSERT_EQ(path.size(), expected.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    // Both end near one minimum; runs end where a step promises 1e-5 of the cost, which is less
    // than a millimetre.
    EXPECT_LT(difference(path[i].T_mb, expected[i].T_mb), 1e-3) << i;
  }
}

TEST_F(PoseGraphTest, WhatCannotBeIsRefused) {
  const auto graph = this->graph();
  visit(graph.get(), 0);
  EXPECT_THROW(graph->addKeyframe(revisits_.keyframe(0, 3), revisits_.image(3)), InputError)
      << "the id is known";
  EXPECT_THROW(graph->addKeyframe(revisits_.keyframe(9, 3), cv::Mat1b(10, 10)), InputError)
      << "not the camera's size";
  PoseGraphOptions bad = options_;
  bad.skip_distance = -1.0;
  EXPECT_THROW(PoseGraph(bad, revisits_.camera, places_), InputError);
}

TEST(PoseGraphStatistics, TellsWhyCandidatesWereRejected) {
  PoseGraphStatistics statistics;
  EXPECT_EQ(statistics.describeRejected(), "0 candidates rejected");
  statistics.rejected[LoopStatus::kFewMatches] = 90;
  statistics.rejected[LoopStatus::kFewPoseInliers] = 24;
  EXPECT_EQ(statistics.describeRejected(),
            "114 candidates rejected (90 few matches, 24 few pose inliers)");
}

}  // namespace
}  // namespace vins::pose_graph
