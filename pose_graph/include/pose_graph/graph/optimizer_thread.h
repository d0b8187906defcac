#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "pose_graph/graph/four_dof.h"
#include "pose_graph/graph/keyframe_graph.h"

namespace vins::pose_graph {

/// A keyframe graph that several threads work on, one at a time.
class SharedKeyframeGraph {
 public:
  explicit SharedKeyframeGraph(KeyframeGraph graph) : graph_(std::move(graph)) {}

  /// Calls f(KeyframeGraph&) while no other thread has the graph; returns what f returns.
  template <typename F>
  auto use(F&& f) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::forward<F>(f)(graph_);
  }

 private:
  std::mutex mutex_;
  KeyframeGraph graph_;
};

/// Optimizes a shared graph on a thread of its own: takes a snapshot, solves it while the graph
/// grows on, and merges what came out (KeyframeGraph::apply()). Requests made while it is busy
/// become one next run, on the graph as it is then.
class OptimizerThread {
 public:
  using Callback = std::function<void(const FourDofResult&)>;

  /// `graph` must outlive this. `on_merged` is called after each run, on the thread that ran it,
  /// without any lock held; it must not throw. Throws InputError where an option is out of range.
  OptimizerThread(SharedKeyframeGraph* graph, const FourDofOptions& options,
                  Callback on_merged = {});

  /// Waits for the run under way, drops requests beyond it, ends the thread.
  ~OptimizerThread();
  OptimizerThread(const OptimizerThread&) = delete;
  OptimizerThread& operator=(const OptimizerThread&) = delete;

  /// Asks for a run on the newest graph; returns at once.
  void request();

  /// Waits until no run is under way or asked for.
  void waitUntilIdle();

  /// One run in the calling thread, for programs that must do the same on every run. Not beside
  /// request(): runs under way are waited for.
  FourDofResult solveNow();

 private:
  void work();
  FourDofResult runOnce();

  SharedKeyframeGraph* graph_;
  FourDofOptions options_;
  Callback on_merged_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool requested_ = false;
  bool busy_ = false;
  bool stopping_ = false;
  std::thread thread_;  ///< last: it starts when all else is there
};

}  // namespace vins::pose_graph
