#include "pose_graph/graph/loop_thinning.h"

#include <set>

#include <gtest/gtest.h>

#include "synthetic_keyframes.h"

namespace vins::pose_graph {
namespace {

/// Allows ten loops.
ThinningOptions tenLoops() {
  ThinningOptions options;
  options.max_keyframes = 40;
  options.loops_per_keyframe = 0.25;
  options.thin_to = 1.0;
  return options;
}

std::set<std::int64_t> queriesOf(const std::vector<LoopEdge>& loops) {
  std::set<std::int64_t> queries;
  for (const LoopEdge& loop : loops) queries.insert(loop.query_id);
  return queries;
}

TEST(LoopThinning, LeavesFewLoopsAlone) {
  const testing::SyntheticKeyframes run(40, 20, 0.0, 1);
  KeyframeGraph graph;
  run.addTo(&graph);
  for (std::size_t i = 20; i < 30; ++i) graph.addLoopEdge(run.loop(i - 20, i));
  EXPECT_TRUE(redundantLoops(graph, tenLoops()).empty());
  graph.addLoopEdge(run.loop(10, 30));
  EXPECT_EQ(redundantLoops(graph, tenLoops()).size(), 1u);
}

TEST(LoopThinning, TakesThoseThatAnotherRepeats) {
  const testing::SyntheticKeyframes run(200, 100, 0.0, 1);
  KeyframeGraph graph;
  run.addTo(&graph);
  // Nine loops ten keyframes apart; beside two of them stand others, of the next keyframes.
  for (std::size_t i = 110; i < 200; i += 10) graph.addLoopEdge(run.loop(i - 100, i));
  graph.addLoopEdge(run.loop(31, 131));
  graph.addLoopEdge(run.loop(71, 171));
  graph.addLoopEdge(run.loop(10, 172));  // the same time, but another place
  const auto redundant = redundantLoops(graph, tenLoops());
  EXPECT_EQ(queriesOf(redundant), (std::set<std::int64_t>{130, 170})) << "the older of each pair";
}

TEST(LoopThinning, TheLastLoopBetweenTwoRunsStays) {
  // Twelve runs of the odometry, each tied to the first by one loop, and one run by two.
  const testing::SyntheticKeyframes run(20, 20, 0.0, 1);
  KeyframeGraph graph;
  const auto firstOf = [](std::uint32_t sequence) { return 100 * std::int64_t{sequence}; };
  for (std::uint32_t i = 0; i <= 12; ++i) run.addTo(&graph, i, firstOf(i));
  const auto join = [&](std::uint32_t sequence, std::size_t at) {
    LoopEdge loop = run.loop(at, at);
    loop.query_id += firstOf(sequence);
    graph.addLoopEdge(loop);
  };
  for (std::uint32_t i = 1; i <= 12; ++i) join(i, 5);
  join(7, 15);
  const auto redundant = redundantLoops(graph, tenLoops());
  ASSERT_EQ(redundant.size(), 1u) << "more than ten are left: each of them ties another run";
  EXPECT_EQ(redundant[0].query_id, firstOf(7) + 5);
}

TEST(LoopThinning, TakenOutOneByOneTheLoopsLieEvenly) {
  const testing::SyntheticKeyframes run(200, 20, 0.001, 2);
  KeyframeGraph graph;
  run.addTo(&graph);
  for (std::size_t i = 20; i < 200; ++i) graph.addLoopEdge(run.loop(i % 20, i));
  for (const LoopEdge& loop : redundantLoops(graph, tenLoops())) {
    EXPECT_TRUE(graph.removeLoopEdge(loop.query_id, loop.old_id));
    EXPECT_FALSE(graph.removeLoopEdge(loop.query_id, loop.old_id)) << "it is gone";
  }
  ASSERT_EQ(graph.loops().size(), 10u);
  const std::set<std::int64_t> queries = queriesOf(graph.loops());
  EXPECT_LT(*queries.begin(), 45) << "180 keyframes, ten loops";
  EXPECT_GT(*queries.rbegin(), 175);
}

}  // namespace
}  // namespace vins::pose_graph
