#include "pose_graph/graph/optimizer_thread.h"

namespace vins::pose_graph {

OptimizerThread::OptimizerThread(SharedKeyframeGraph* graph, const FourDofOptions& options,
                                 Callback on_merged)
    : graph_(graph), options_(options), on_merged_(std::move(on_merged)) {
  options_.validate();
  thread_ = std::thread([this] { work(); });
}

OptimizerThread::~OptimizerThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void OptimizerThread::request() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    requested_ = true;
  }
  changed_.notify_all();
}

void OptimizerThread::waitUntilIdle() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !requested_ && !busy_; });
}

FourDofResult OptimizerThread::solveNow() {
  waitUntilIdle();
  return runOnce();
}

void OptimizerThread::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return requested_ || stopping_; });
    if (stopping_) return;
    requested_ = false;
    busy_ = true;
    lock.unlock();
    runOnce();
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
}

FourDofResult OptimizerThread::runOnce() {
  const KeyframeGraph snapshot = graph_->use([](const KeyframeGraph& graph) { return graph; });
  FourDofResult result = optimizeFourDof(snapshot, options_);
  graph_->use([&result](KeyframeGraph& graph) { graph.apply(result.correction); });
  if (on_merged_) on_merged_(result);
  return result;
}

}  // namespace vins::pose_graph
