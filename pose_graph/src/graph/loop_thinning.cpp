#include "pose_graph/graph/loop_thinning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace vins::pose_graph {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A loop by its ends in time; its number is that in the graph's list.
struct Candidate {
  SequenceNumber old_sequence = 0, query_sequence = 0;
  Stamp old_stamp = 0, query_stamp = 0;
  bool is_there = true;
  double distance = kNever;   ///< to the nearest other [s]
  std::size_t neighbour = 0;  ///< its number, where the distance is finite
};

double distanceBetween(const Candidate& a, const Candidate& b) {
  if (a.old_sequence != b.old_sequence || a.query_sequence != b.query_sequence) return kNever;
  return std::hypot(toSeconds(a.old_stamp - b.old_stamp), toSeconds(a.query_stamp - b.query_stamp));
}

class LoopCrowd {
 public:
  explicit LoopCrowd(const KeyframeGraph& graph) {
    for (const LoopEdge& loop : graph.loops()) {
      const KeyframeVertex& old = graph.vertices().at(loop.old_id);
      const KeyframeVertex& query = graph.vertices().at(loop.query_id);
      candidates_.push_back(
          {old.sequence, query.sequence, old.stamp, query.stamp, true, kNever, 0});
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i) findNeighbour(i);
  }

  /// Index of the loop that was taken out; the number of loops where none may leave.
  std::size_t removeOne() {
    const auto chosen =
        std::min_element(candidates_.begin(), candidates_.end(),
                         [](const auto& a, const auto& b) { return rank(a) < rank(b); });
    if (chosen == candidates_.end() || !chosen->is_there || chosen->distance == kNever) {
      return candidates_.size();
    }
    chosen->is_there = false;
    const auto number = static_cast<std::size_t>(chosen - candidates_.begin());
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (candidates_[i].is_there && candidates_[i].neighbour == number) findNeighbour(i);
    }
    return number;
  }

 private:
  static std::tuple<bool, double, Stamp, Stamp> rank(const Candidate& candidate) {
    return {!candidate.is_there, candidate.distance, candidate.query_stamp, candidate.old_stamp};
  }

  void findNeighbour(std::size_t i) {
    candidates_[i].distance = kNever;
    candidates_[i].neighbour = candidates_.size();
    for (std::size_t j = 0; j < candidates_.size(); ++j) {
      if (j == i || !candidates_[j].is_there) continue;
      const double distance = distanceBetween(candidates_[i], candidates_[j]);
      if (distance >= candidates_[i].distance) continue;
      candidates_[i].distance = distance;
      candidates_[i].neighbour = j;
    }
  }

  std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<LoopEdge> redundantLoops(const KeyframeGraph& graph, const ThinningOptions& options) {
  options.validate();
  std::vector<LoopEdge> redundant;
  const double limit = options.loops_per_keyframe * options.max_keyframes;
  const std::size_t count = graph.loops().size();
  if (static_cast<double>(count) <= limit) return redundant;
  const auto left = static_cast<std::size_t>(options.thin_to * limit);
  LoopCrowd crowd(graph);
  while (count - redundant.size() > left) {
    const std::size_t index = crowd.removeOne();
    if (index == count) break;
    redundant.push_back(graph.loops()[index]);
  }
  return redundant;
}

}  // namespace vins::pose_graph
