#include "pose_graph/graph/keyframe_graph.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "pose_graph/graph/heading.h"
#include "synthetic_keyframes.h"
#include "vins_core/input_error.h"
#include "vins_core/pose_covariance.h"

namespace vins::pose_graph {
namespace {

using Eigen::Vector3d;
using testing::difference;
using testing::SyntheticKeyframes;

// Products of a few poses of some ten metres: rounding of about 1e-15 of that, with room.
constexpr double kRounding = 1e-12;

/// A body whose x axis points up, where Euler's yaw is undefined.
const Eigen::Quaterniond kNoseUp = so3::exp(Vector3d(0.0, -M_PI / 2.0, 0.0));

const KeyframeVertex& vertex(const KeyframeGraph& graph, std::int64_t id) {
  return graph.vertices().at(id);
}

TEST(Heading, TwistIsTheYawOfAnyTilt) {
  for (const double yaw : {-3.1, -1.0, 0.0, 0.3, 3.1}) {
    EXPECT_NEAR(yawOf(yawRotation(yaw)), yaw, 1e-15);
    // A tilt about a horizontal axis has no twist: the yaw comes out alone, from q and from -q.
    const Eigen::Quaterniond R = yawRotation(yaw) * so3::exp(Vector3d(0.9, -1.2, 0.0));
    EXPECT_NEAR(yawOf(R), yaw, 1e-14);
    EXPECT_NEAR(yawOf(Eigen::Quaterniond(-R.coeffs())), yaw, 1e-14);
  }
  EXPECT_NEAR(wrapAngle(3.0 * M_PI + 0.1), -M_PI + 0.1, 1e-14);
  EXPECT_EQ(wrapAngle(-M_PI), M_PI);
}

TEST(Heading, DriftTakesOdometryToMap) {
  const Pose T_mw(yawRotation(2.0), {1.0, -2.0, 3.0});
  const Pose T_wb(so3::exp(Vector3d(1.0, 1.5, -0.7)), {4.0, 5.0, 6.0});
  EXPECT_LT(difference(driftOf(T_mw * T_wb, T_wb), T_mw), kRounding);
}

TEST(KeyframeGraph, HasEdgesToThePredecessorsOfTheSameSequence) {
  KeyframeGraph graph;
  SyntheticKeyframes(8, 20, 0.0, 1).addTo(&graph, 0, 0);
  SyntheticKeyframes(3, 20, 0.0, 1).addTo(&graph, 1, 100);
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  for (const HeadingEdge& edge : graph.edges()) pairs.emplace_back(edge.from, edge.to);
  std::vector<std::pair<std::int64_t, std::int64_t>> expected;
  for (int to = 1; to < 8; ++to) {
    for (int from = std::max(0, to - 5); from < to; ++from) expected.emplace_back(from, to);
  }
  expected.insert(expected.end(), {{100, 101}, {100, 102}, {101, 102}});
  EXPECT_EQ(pairs, expected);
}

TEST(KeyframeGraph, EdgesDoNotDependOnWhereTheOdometryBegan) {
  const SyntheticKeyframes keyframes(6, 20, 0.1, 2, kNoseUp);
  KeyframeGraph here, there;
  const Pose T_there_here(yawRotation(1.1), {10.0, 20.0, -5.0});
  for (int i = 0; i < 6; ++i) {
    const Pose& T_wb = keyframes.odometry[std::size_t(i)];
    here.addKeyframe(i, 0, i + 1, T_wb);
    there.addKeyframe(i, 0, i + 1, T_there_here * T_wb);
  }
  here.addLoopEdge(keyframes.loop(0, 5));
  there.addLoopEdge(keyframes.loop(0, 5));
  const auto a = here.edges(), b = there.edges();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    // The heading frames turn with the odometry's world.
    EXPECT_LT((T_there_here.rotation * a[k].position - b[k].position).norm(), kRounding);
    EXPECT_NEAR(a[k].yaw, b[k].yaw, kRounding);
    EXPECT_NEAR(a[k].position_sigma, b[k].position_sigma, kRounding);
  }
}

TEST(KeyframeGraph, ComposedEdgesAreAsUncertainAsTheStepsTheyReplace) {
  KeyframeGraphOptions options;
  options.predecessors = 1;
  KeyframeGraph graph(options);
  const SyntheticKeyframes keyframes(4, 20, 0.1, 3);
  keyframes.addTo(&graph);
  const auto before = graph.edges();
  EXPECT_TRUE(graph.removeKeyframe(1));
  EXPECT_FALSE(graph.removeKeyframe(1));
  const auto after = graph.edges();
  ASSERT_EQ(after.size(), 2u);
  EXPECT_EQ(after[0].from, 0);
  EXPECT_EQ(after[0].to, 2);
  EXPECT_LT((after[0].position - before[0].position - before[1].position).norm(), kRounding);
  EXPECT_NEAR(after[0].position_sigma,
              std::hypot(before[0].position_sigma, before[1].position_sigma), kRounding);
  EXPECT_NEAR(after[0].yaw_sigma, std::hypot(before[0].yaw_sigma, before[1].yaw_sigma), kRounding);
}

TEST(KeyframeGraph, PredecessorsLongAgoAreOneOnly) {
  // Half a second apart, then with a gap that removed keyframes have left.
  const SyntheticKeyframes keyframes(20, 20, 0.1, 3);
  KeyframeGraph graph;
  keyframes.addTo(&graph);
  for (std::int64_t id = 6; id < 13; ++id) graph.removeKeyframe(id);
  std::map<std::int64_t, std::vector<HeadingEdge>> edges;  // by the later end
  for (const HeadingEdge& edge : graph.edges()) edges[edge.to].push_back(edge);
  EXPECT_EQ(edges[5].size(), 5u);
  ASSERT_EQ(edges[13].size(), 1u) << "the others are more than 3 s older";
  EXPECT_EQ(edges[13][0].from, 5);
  EXPECT_EQ(edges[14].size(), 1u);
  EXPECT_EQ(edges[19].size(), 5u);
  // The one edge says as much as many would: eight steps of half a second.
  const double drift = KeyframeGraphOptions().position_drift;
  EXPECT_NEAR(edges[13][0].position_sigma, drift * std::sqrt(8 * 0.5), kRounding);
}

TEST(KeyframeGraph, UpdatedOdometryRemakesEdgesAndCarriesTheMapPoseAlong) {
  KeyframeGraph graph;
  const SyntheticKeyframes keyframes(3, 20, 0.1, 4, kNoseUp);
  keyframes.addTo(&graph);
  const Pose T_mw(yawRotation(-0.8), {3.0, 1.0, 2.0});
  graph.apply({{{0, T_mw}, {1, T_mw}, {2, T_mw}}, {{0, 0}}});
  const Pose moved = keyframes.odometry[1] * Pose(so3::exp(Vector3d(0.1, 0.2, 0.3)), {1, 2, 3});
  EXPECT_TRUE(graph.updateOdometry(1, moved));
  EXPECT_LT(difference(vertex(graph, 1).T_mb, T_mw * moved), kRounding);
  EXPECT_LT((graph.edges()[0].position - (moved.position - keyframes.odometry[0].position)).norm(),
            kRounding);
  EXPECT_FALSE(graph.updateOdometry(77, moved));
}

TEST(KeyframeGraph, ASequenceInTheSameWorldBeginsWithTheCorrectionOfTheOneBefore) {
  const SyntheticKeyframes run(10, 20, 0.0, 5, kNoseUp);
  KeyframeGraph graph;
  const Pose T_wm(yawRotation(0.3), {1.0, -2.0, 0.5});  // the odometry has drifted by that
  for (int i = 0; i < 10; ++i) {
    graph.addKeyframe(i, 0, i, T_wm * run.truth[std::size_t(i)], 7);
  }
  MapFromOdom drifted{T_wm.inverse()};
  drifted.covariance.diagonal() << 0.1, 0.2, 0.3, 0.0, 0.0, 0.4;
  ASSERT_TRUE(graph.placeSequence(0, drifted));
  EXPECT_LT(difference(vertex(graph, 9).T_mb, run.truth[9]), kRounding);
  EXPECT_LT((graph.mapFromOdom(0)->covariance - drifted.covariance).norm(), 1e-9);
  // After a reset.
  graph.addKeyframe(10, 1, 10, T_wm * run.truth[9], 7);
  EXPECT_LT(difference(*graph.drift(1), T_wm.inverse()), kRounding);
  EXPECT_LT((graph.mapFromOdom(1)->covariance - drifted.covariance).norm(), 1e-9);
  EXPECT_LT(difference(vertex(graph, 10).T_mb, run.truth[9]), kRounding);
  EXPECT_FALSE(graph.inMap(1)) << "no loop has said so";
  EXPECT_FALSE(graph.beginsWorld(1));
  // Another world has its own frame.
  graph.addKeyframe(11, 2, 11, run.truth[3], 8);
  EXPECT_LT(difference(*graph.drift(2), Pose()), kRounding);
  EXPECT_TRUE(graph.beginsWorld(2));
  EXPECT_FALSE(graph.placeSequence(5, {})) << "unknown";
}

TEST(KeyframeGraph, TheLoopThatJoinsASequenceTellsHowWellItIsKnown) {
  const SyntheticKeyframes old_run(10, 20, 0.0, 5, kNoseUp);
  KeyframeGraph graph;
  old_run.addTo(&graph, 0, 0);
  const Pose T_wm(yawRotation(2.5), {-7.0, 3.0, 1.0});
  for (int i = 0; i < 10; ++i) {
    graph.addKeyframe(100 + i, 1, 1000 + i, T_wm * old_run.truth[std::size_t(i)]);
  }
  LoopEdge loop = old_run.loop(3, 6);
  loop.query_id = 106;
  loop.covariance.setZero();
  loop.covariance.diagonal().head<3>().setConstant(0.04);
  loop.covariance.diagonal().tail<3>().setConstant(0.01);
  ASSERT_EQ(graph.addLoopEdge(loop), LoopOutcome::kJoined);
  EXPECT_FALSE(graph.placeSequence(1, {})) << "it shares the older one's frame";
  // Where the loop was measured, the transform is as good as the loop.
  const MapFromOdom found = graph.mapFromOdom(1).value();
  const se3::Matrix6d there = covarianceOfProduct(found.pose, found.covariance,
                                                  T_wm * old_run.truth[6], se3::Matrix6d::Zero());
  const KeyframeGraphOptions options;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(there(i, i), 0.04 + std::pow(options.loop_position_sigma, 2), 1e-9) << i;
  }
  EXPECT_NEAR(there(5, 5), 0.01 + std::pow(options.loop_yaw_sigma, 2), 1e-9);
  EXPECT_NEAR(there(3, 3), 0.0, 1e-12) << "roll and pitch are the odometry's";
  EXPECT_EQ(graph.mapFromOdom(0)->covariance, se3::Matrix6d(se3::Matrix6d::Zero()));
}

TEST(KeyframeGraph, FirstLoopMovesTheWholeYoungerSequence) {
  const SyntheticKeyframes old_run(10, 20, 0.0, 5, kNoseUp);
  KeyframeGraph graph;
  old_run.addTo(&graph, 0, 0);
  const Pose T_wm(yawRotation(2.5), {-7.0, 3.0, 1.0});  // the second odometry began elsewhere
  for (int i = 0; i < 10; ++i) {
    graph.addKeyframe(100 + i, 1, 1000 + i, T_wm * old_run.truth[std::size_t(i)]);
  }
  EXPECT_FALSE(graph.inMap(1));
  EXPECT_LT(difference(*graph.drift(1), Pose()), kRounding);
  LoopEdge loop = old_run.loop(3, 6);
  loop.query_id = 106;
  EXPECT_EQ(graph.addLoopEdge(loop), LoopOutcome::kJoined);
  EXPECT_TRUE(graph.inMap(1));
  for (int i = 0; i < 10; ++i) {
    const Pose& truth = old_run.truth[std::size_t(i)];
    EXPECT_LT(difference(vertex(graph, 100 + i).T_mb, truth), kRounding) << i;
    EXPECT_EQ(vertex(graph, i).T_mb.position, truth.position) << "the older one stays";
  }
  EXPECT_LT(difference(*graph.drift(1), T_wm.inverse()), kRounding);
  // What comes later is in the map at once, and another loop joins nothing.
  graph.addKeyframe(110, 1, 2000, T_wm * old_run.truth[0]);
  EXPECT_LT(difference(vertex(graph, 110).T_mb, old_run.truth[0]), kRounding);
  loop = old_run.loop(1, 2);
  loop.query_id = 102;
  EXPECT_EQ(graph.addLoopEdge(loop), LoopOutcome::kAdded);
}

TEST(KeyframeGraph, SequencesJoinedAmongThemselvesMoveTogether) {
  const SyntheticKeyframes run(6, 20, 0.0, 6);
  KeyframeGraph graph;
  const Pose elsewhere(yawRotation(1.0), {5.0, 0.0, 0.0});
  const Pose nowhere(yawRotation(-2.0), {0.0, 9.0, 4.0});
  for (int i = 0; i < 6; ++i) {
    graph.addKeyframe(i, 0, i + 1, run.truth[std::size_t(i)]);
    graph.addKeyframe(10 + i, 1, i + 1, elsewhere * run.truth[std::size_t(i)]);
    graph.addKeyframe(20 + i, 2, i + 1, nowhere * run.truth[std::size_t(i)]);
  }
  LoopEdge loop = run.loop(2, 3);
  loop.old_id = 22;  // the newer sequence is the loop's old end: it moves all the same
  loop.query_id = 13;
  EXPECT_EQ(graph.addLoopEdge(loop), LoopOutcome::kJoined);
  EXPECT_EQ(graph.component(2), 1);
  EXPECT_FALSE(graph.inMap(2));
  EXPECT_LT(difference(vertex(graph, 25).T_mb, elsewhere * run.truth[5]), kRounding);
  loop = run.loop(0, 4);
  loop.query_id = 24;
  EXPECT_EQ(graph.addLoopEdge(loop), LoopOutcome::kJoined);
  EXPECT_TRUE(graph.inMap(1));
  EXPECT_LT(difference(vertex(graph, 15).T_mb, run.truth[5]), kRounding);
  EXPECT_LT(difference(vertex(graph, 25).T_mb, run.truth[5]), kRounding);
}

TEST(KeyframeGraph, ABetterMeasurementTakesTheFirstOnesPlace) {
  const SyntheticKeyframes run(8, 20, 0.0, 7);
  KeyframeGraph graph;
  run.addTo(&graph);
  LoopEdge first = run.loop(1, 6);
  first.T_old_query.position.x() += 0.3;
  EXPECT_EQ(graph.addLoopEdge(first), LoopOutcome::kAdded);
  EXPECT_EQ(graph.addLoopEdge(run.loop(2, 7)), LoopOutcome::kAdded);
  EXPECT_EQ(graph.addLoopEdge(run.loop(1, 6)), LoopOutcome::kReplaced);
  ASSERT_EQ(graph.loops().size(), 2u);
  EXPECT_LT(difference(graph.loops()[0].T_old_query, run.loop(1, 6).T_old_query), kRounding);
  // The same keyframe may be the end of several loops.
  EXPECT_EQ(graph.addLoopEdge(run.loop(2, 6)), LoopOutcome::kAdded);
  EXPECT_EQ(graph.loops().size(), 3u);
}

TEST(KeyframeGraph, RefusesLoopsThatMeanNothing) {
  const SyntheticKeyframes run(6, 20, 0.0, 7);
  KeyframeGraph graph;
  run.addTo(&graph);
  LoopEdge loop = run.loop(0, 5);
  loop.old_id = 99;
  EXPECT_EQ(graph.addLoopEdge(loop), LoopOutcome::kUnknownKeyframe);
  EXPECT_EQ(graph.addLoopEdge(run.loop(2, 2)), LoopOutcome::kUnusable);
  loop = run.loop(0, 5);
  loop.T_old_query.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(graph.addLoopEdge(loop), LoopOutcome::kUnusable);
  EXPECT_TRUE(graph.loops().empty());
}

TEST(KeyframeGraph, RemovedLoopEndHandsItsLoopToItsNeighbour) {
  const SyntheticKeyframes run(30, 20, 0.0, 8, kNoseUp);
  KeyframeGraph graph;
  run.addTo(&graph);
  graph.addLoopEdge(run.loop(2, 25));
  const HeadingEdge before = graph.edges().back();
  graph.removeKeyframe(2);
  graph.removeKeyframe(25);
  ASSERT_EQ(graph.loops().size(), 1u);
  const LoopEdge& loop = graph.loops().front();
  // Both neighbours are as near; the earlier one is taken.
  EXPECT_EQ(loop.old_id, 1);
  EXPECT_EQ(loop.query_id, 24);
  EXPECT_LT(difference(loop.T_old_query, run.truth[1].inverse() * run.truth[24]), kRounding);
  EXPECT_GT(graph.edges().back().position_sigma, before.position_sigma);
  EXPECT_GT(graph.edges().back().yaw_sigma, before.yaw_sigma);
}

TEST(KeyframeGraph, RemovingEverythingKeepsTheDrift) {
  KeyframeGraph graph;
  SyntheticKeyframes(3, 20, 0.0, 9).addTo(&graph);
  const Pose T_mw(yawRotation(0.4), {1.0, 2.0, 3.0});
  graph.apply({{{0, T_mw}, {1, T_mw}, {2, T_mw}}, {{0, 0}}});
  for (const std::int64_t id : {2, 0, 1}) EXPECT_TRUE(graph.removeKeyframe(id));
  EXPECT_TRUE(graph.edges().empty());
  EXPECT_LT(difference(*graph.drift(0), T_mw), kRounding);
  EXPECT_FALSE(graph.drift(5).has_value());
}

TEST(KeyframeGraph, CorrectionsMoveWhatHasComeSince) {
  const SyntheticKeyframes run(6, 20, 0.0, 10);
  KeyframeGraph graph;
  run.addTo(&graph);
  const Pose T_mw(yawRotation(0.4), {1.0, 2.0, 3.0});
  // Optimized when there were keyframes 0 to 3, of which 1 is gone by now.
  graph.removeKeyframe(1);
  graph.apply({{{1, T_mw}, {2, T_mw}, {3, T_mw}}, {{0, 0}}});
  EXPECT_EQ(difference(vertex(graph, 0).T_mb, run.truth[0]), 0.0);
  for (const int i : {2, 3, 4, 5}) {
    EXPECT_LT(difference(vertex(graph, i).T_mb, T_mw * run.truth[std::size_t(i)]), kRounding);
  }
  EXPECT_LT(difference(*graph.drift(0), T_mw), kRounding);
}

TEST(KeyframeGraph, CorrectionsInAFrameThatIsNoMoreAreDropped) {
  const SyntheticKeyframes run(6, 20, 0.0, 11);
  KeyframeGraph graph;
  run.addTo(&graph, 0, 0);
  run.addTo(&graph, 1, 10);
  LoopEdge loop = run.loop(0, 3);
  loop.query_id = 13;
  graph.addLoopEdge(loop);
  const Pose before = vertex(graph, 14).T_mb;
  // Made when sequence 1 was still by itself.
  graph.apply({{{14, Pose(yawRotation(1.0), {9.0, 9.0, 9.0})}}, {{0, 0}, {1, 1}}});
  EXPECT_EQ(difference(vertex(graph, 14).T_mb, before), 0.0);
}

TEST(KeyframeGraph, RestoredGraphIsTheStoredOne) {
  const SyntheticKeyframes run(12, 20, 0.1, 12);
  KeyframeGraph graph;
  run.addTo(&graph, 0, 0);
  run.addTo(&graph, 3, 20);
  LoopEdge loop = run.loop(0, 3);
  loop.query_id = 23;
  graph.addLoopEdge(loop);
  std::vector<KeyframeVertex> vertices;
  for (const auto& item : graph.vertices()) vertices.push_back(item.second);
  const KeyframeGraph copy = KeyframeGraph::restore({}, vertices, graph.loops());
  EXPECT_EQ(copy.component(3), 0);
  for (const auto& [id, v] : graph.vertices()) {
    EXPECT_EQ(difference(vertex(copy, id).T_mb, v.T_mb), 0.0);
  }
  EXPECT_LT(difference(*copy.drift(3), *graph.drift(3)), kRounding);
  EXPECT_EQ(copy.edges().size(), graph.edges().size());
  loop.old_id = 99;
  EXPECT_THROW(KeyframeGraph::restore({}, vertices, {loop}), InputError);
}

std::string messageOf(KeyframeGraph* graph, std::int64_t id, Stamp stamp, const Pose& T_wb) {
  try {
    graph->addKeyframe(id, 0, stamp, T_wb);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(KeyframeGraph, RefusesKeyframesThatMeanNothingAndStaysWhole) {
  KeyframeGraph graph;
  graph.addKeyframe(1, 0, 100, Pose());
  Pose broken;
  broken.position.y() = std::numeric_limits<double>::infinity();
  EXPECT_NE(messageOf(&graph, 1, 200, Pose()).find("keyframe 1"), std::string::npos);
  EXPECT_NE(messageOf(&graph, 2, 100, Pose()).find("stamp 100"), std::string::npos);
  EXPECT_NE(messageOf(&graph, 2, 200, broken).find("finite"), std::string::npos);
  EXPECT_EQ(graph.vertices().size(), 1u);
  EXPECT_EQ(graph.keyframesOf(0).size(), 1u);
  KeyframeGraphOptions options;
  options.yaw_drift = 0.0;
  EXPECT_THROW(KeyframeGraph{options}, InputError);
}

}  // namespace
}  // namespace vins::pose_graph
