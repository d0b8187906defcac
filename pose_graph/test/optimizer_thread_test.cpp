#include "pose_graph/graph/optimizer_thread.h"

#include <atomic>
#include <future>

#include <gtest/gtest.h>

#include "synthetic_keyframes.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::difference;
using testing::SyntheticKeyframes;

KeyframeGraph graphOf(const SyntheticKeyframes& run, std::size_t loops_from) {
  KeyframeGraph graph(testing::exactLoops());
  run.addTo(&graph);
  for (std::size_t i = loops_from; i < run.truth.size(); i += 5) {
    graph.addLoopEdge(run.loop(i - 20, i));
  }
  return graph;
}

TEST(OptimizerThread, MergesWhatItFinds) {
  const SyntheticKeyframes run(100, 20, 0.02, 1);
  SharedKeyframeGraph graph(graphOf(run, 20));
  const auto error = [&run](const KeyframeGraph& g) { return testing::loopError(g, run.truth); };
  EXPECT_GT(graph.use(error), 0.1);
  OptimizerThread optimizer(&graph, {});
  optimizer.request();
  optimizer.waitUntilIdle();
  // As in the test of the solver itself: less than the loops' sigma.
  EXPECT_LT(graph.use(error), 0.005);
}

TEST(OptimizerThread, SolveNowGivesTheSameEveryTime) {
  const SyntheticKeyframes run(100, 20, 0.02, 2);
  std::vector<KeyframeGraph> results;
  for (int i = 0; i < 2; ++i) {
    SharedKeyframeGraph graph(graphOf(run, 20));
    OptimizerThread optimizer(&graph, {});
    EXPECT_EQ(optimizer.solveNow().summary.status, MinimizerStatus::kConverged);
    results.push_back(graph.use([](const KeyframeGraph& g) { return g; }));
  }
  for (const auto& [id, vertex] : results[0].vertices()) {
    const Pose& other = results[1].vertices().at(id).T_mb;
    EXPECT_EQ(vertex.T_mb.position, other.position);
    EXPECT_EQ(vertex.T_mb.rotation.coeffs(), other.rotation.coeffs());
  }
}

/// Holds runs up at their end, so that a test decides what happens meanwhile.
class Gate {
 public:
  void pass() {
    ++runs_;
    if (runs_ == 1) {
      arrived_.set_value();
      open_.get_future().wait();
    }
  }
  void waitForFirst() { arrived_.get_future().wait(); }
  void open() { open_.set_value(); }
  int runs() const { return runs_; }

 private:
  std::promise<void> arrived_, open_;
  std::atomic<int> runs_{0};
};

TEST(OptimizerThread, RequestsWhileBusyBecomeOneRunOnTheNewestGraph) {
  const SyntheticKeyframes run(60, 20, 0.02, 3);
  SharedKeyframeGraph graph(graphOf(run, 40));
  Gate gate;
  std::size_t optimized = 0;
  OptimizerThread optimizer(&graph, {}, [&](const FourDofResult& result) {
    optimized = result.correction.T_mw.size();
    gate.pass();
  });
  optimizer.request();
  gate.waitForFirst();
  // While the first run is held up, the graph grows: a loop to the first keyframe frees all others.
  for (int i = 0; i < 50; ++i) optimizer.request();
  graph.use([&run](KeyframeGraph& g) { g.addLoopEdge(run.loop(0, 59)); });
  gate.open();
  optimizer.waitUntilIdle();
  EXPECT_EQ(gate.runs(), 2);
  EXPECT_EQ(optimized, 59u);
}

TEST(OptimizerThread, DestructorDropsWhatIsNotBegun) {
  const SyntheticKeyframes run(60, 20, 0.02, 4);
  SharedKeyframeGraph graph(graphOf(run, 20));
  Gate gate;
  std::thread opener;
  {
    OptimizerThread optimizer(&graph, {}, [&gate](const FourDofResult&) { gate.pass(); });
    optimizer.request();
    gate.waitForFirst();
    optimizer.request();
    // The destructor has to be waiting for the run when the gate opens.
    opener = std::thread([&gate] {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      gate.open();
    });
  }
  EXPECT_EQ(gate.runs(), 1);
  opener.join();
}

TEST(OptimizerThread, GraphGrowsWhileItIsOptimized) {
  const SyntheticKeyframes run(300, 20, 0.02, 5);
  SharedKeyframeGraph graph((KeyframeGraph()));
  OptimizerThread optimizer(&graph, {});
  for (std::size_t i = 0; i < run.odometry.size(); ++i) {
    graph.use([&](KeyframeGraph& g) {
      const auto id = static_cast<std::int64_t>(i);
      g.addKeyframe(id, 0, SyntheticKeyframes::kPeriod * (id + 1), run.odometry[i]);
      if (i >= 20 && i % 10 == 0) g.addLoopEdge(run.loop(i - 20, i));
    });
    optimizer.request();
  }
  optimizer.waitUntilIdle();
  // The last request came after the last keyframe: whatever was merged when, the end is the same.
  const FourDofResult again = optimizer.solveNow();
  EXPECT_NEAR(again.summary.final_cost, again.summary.initial_cost,
              1e-5 * again.summary.initial_cost);
}

TEST(OptimizerThread, RefusesOptionsBeforeItStarts) {
  SharedKeyframeGraph graph((KeyframeGraph()));
  FourDofOptions options;
  options.minimizer.max_iterations = -1;
  EXPECT_THROW(OptimizerThread(&graph, options), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
