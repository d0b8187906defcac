// Cost of optimizing 2,000 keyframes with 200 loops in four degrees of freedom, and of choosing
// which keyframes leave a full map.

#include <benchmark/benchmark.h>

#include "pose_graph/graph/four_dof.h"
#include "pose_graph/graph/thinning.h"
#include "synthetic_keyframes.h"

namespace {

/// Rounds of 100 keyframes; each tenth one, from the second round on, closes a loop.
vins::pose_graph::KeyframeGraph makeGraph(int keyframes, int loops) {
  const vins::pose_graph::testing::SyntheticKeyframes run(keyframes, 100, 0.01, 1);
  vins::pose_graph::KeyframeGraph graph;
  run.addTo(&graph);
  const auto count = static_cast<std::size_t>(loops);
  const std::size_t span = static_cast<std::size_t>(keyframes) - 100;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t query = 100 + i * span / count;
    graph.addLoopEdge(run.loop(query - 100, query));
  }
  return graph;
}

/// From the drifted odometry: the worst case, when all loops come at once.
void fourDofFromOdometry(benchmark::State& state) {
  const vins::pose_graph::KeyframeGraph graph = makeGraph(2000, 200);
  vins::pose_graph::FourDofResult result;
  for (auto _ : state) result = vins::pose_graph::optimizeFourDof(graph, {});
  state.counters["iterations"] = result.summary.iterations;
  state.counters["cost"] = result.summary.final_cost;
}

/// The usual case: all but the last loop have been optimized.
void fourDofAfterOneLoop(benchmark::State& state) {
  vins::pose_graph::KeyframeGraph graph = makeGraph(2000, 199);
  graph.apply(vins::pose_graph::optimizeFourDof(graph, {}).correction);
  vins::LoopEdge loop = graph.loops().back();
  loop.query_id = 1999;
  loop.T_old_query =
      graph.vertices().at(loop.old_id).T_mb.inverse() * graph.vertices().at(1999).T_mb;
  loop.T_old_query.position.x() += 0.2;
  graph.addLoopEdge(loop);
  vins::pose_graph::FourDofResult result;
  for (auto _ : state) result = vins::pose_graph::optimizeFourDof(graph, {});
  state.counters["iterations"] = result.summary.iterations;
}

void snapshot(benchmark::State& state) {
  const vins::pose_graph::KeyframeGraph graph = makeGraph(2000, 200);
  for (auto _ : state) benchmark::DoNotOptimize(vins::pose_graph::KeyframeGraph(graph));
}

void thinning(benchmark::State& state) {
  const vins::pose_graph::KeyframeGraph graph = makeGraph(2001, 200);
  for (auto _ : state) benchmark::DoNotOptimize(vins::pose_graph::redundantKeyframes(graph, {}));
}

BENCHMARK(fourDofFromOdometry)->Unit(benchmark::kMillisecond);
BENCHMARK(fourDofAfterOneLoop)->Unit(benchmark::kMillisecond);
BENCHMARK(snapshot)->Unit(benchmark::kMillisecond);
BENCHMARK(thinning)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
