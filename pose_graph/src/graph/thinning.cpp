#include "pose_graph/graph/thinning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Candidate {
  std::int64_t id = 0;
  SequenceNumber component = 0;
  Pose T_mb;
  bool is_new = false;       ///< stays
  bool is_loop_end = false;  ///< leaves only when no others are left
  bool is_there = true;
  double distance = kNever;   ///< to the nearest neighbour [m]
  std::size_t neighbour = 0;  ///< its number, where the distance is finite
};

/// Keyframes sorted along the map's longest side, so that a search ends where that side alone is
/// farther than the best found.
class Crowd {
 public:
  Crowd(const KeyframeGraph& graph, const ThinningOptions& options)
      : metres_per_radian_(options.metres_per_radian) {
    std::set<std::int64_t> loop_ends;
    for (const LoopEdge& loop : graph.loops()) loop_ends.insert({loop.query_id, loop.old_id});
    // Ids rise with time, over all sequences.
    auto left = static_cast<std::size_t>(options.newest);
    left = graph.vertices().size() - std::min(left, graph.vertices().size());
    for (const auto& [id, vertex] : graph.vertices()) {
      const bool is_new = candidates_.size() >= left;
      candidates_.push_back({id, graph.component(vertex.sequence), vertex.T_mb, is_new,
                             loop_ends.count(id) > 0, true, kNever, 0});
    }
    sortAlongLongestSide();
    for (std::size_t i = 0; i < candidates_.size(); ++i) findNeighbour(i);
  }

  /// Takes the most redundant one out. False: none may leave.
  bool removeOne(std::vector<std::int64_t>* removed) {
    std::size_t chosen = candidates_.size();
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (candidates_[i].is_new || !candidates_[i].is_there) continue;
      if (chosen == candidates_.size() || goesBefore(candidates_[i], candidates_[chosen])) {
        chosen = i;
      }
    }
    if (chosen == candidates_.size()) return false;
    candidates_[chosen].is_there = false;
    removed->push_back(candidates_[chosen].id);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const Candidate& candidate = candidates_[i];
      if (candidate.is_there && candidate.distance < kNever && candidate.neighbour == chosen) {
        findNeighbour(i);
      }
    }
    return true;
  }

 private:
  /// Of two as redundant as each other the older leaves: what the newer saw is more like today.
  static bool goesBefore(const Candidate& a, const Candidate& b) {
    if (a.is_loop_end != b.is_loop_end) return b.is_loop_end;
    return a.distance != b.distance ? a.distance < b.distance : a.id < b.id;
  }

  void sortAlongLongestSide() {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(kNever), high = -low;
    for (const Candidate& candidate : candidates_) {
      low = low.cwiseMin(candidate.T_mb.position);
      high = high.cwiseMax(candidate.T_mb.position);
    }
    (high - low).maxCoeff(&side_);
    std::sort(candidates_.begin(), candidates_.end(), [this](const auto& a, const auto& b) {
      const double x_a = a.T_mb.position[side_], x_b = b.T_mb.position[side_];
      return x_a != x_b ? x_a < x_b : a.id < b.id;
    });
  }

  void findNeighbour(std::size_t i) {
    candidates_[i].distance = kNever;
    for (std::size_t j = i; j-- > 0;) {
      if (!compare(i, j)) break;
    }
    for (std::size_t j = i + 1; j < candidates_.size(); ++j) {
      if (!compare(i, j)) break;
    }
  }

  /// False where all that lie beyond j are farther than the best found.
  bool compare(std::size_t i, std::size_t j) {
    Candidate& a = candidates_[i];
    const Candidate& b = candidates_[j];
    const Eigen::Vector3d d = b.T_mb.position - a.T_mb.position;
    if (std::abs(d[side_]) > a.distance) return false;
    if (!b.is_there || a.component != b.component || d.norm() > a.distance) return true;
    const double turn = metres_per_radian_ * a.T_mb.rotation.angularDistance(b.T_mb.rotation);
    const double distance = std::hypot(d.norm(), turn);
    if (distance < a.distance) {
      a.distance = distance;
      a.neighbour = j;
    }
    return true;
  }

  double metres_per_radian_;
  Eigen::Index side_ = 0;
  std::vector<Candidate> candidates_;
};

}  // namespace

void ThinningOptions::validate() const {
  requireWithin("thinning", "max_keyframes", max_keyframes, {10, 1e6});
  requireWithin("thinning", "thin_to", thin_to, {0.1, 1});
  requireWithin("thinning", "loops_per_keyframe", loops_per_keyframe, {0.01, 10});
  requireWithin("thinning", "newest", newest, {0, 1e6});
  requireWithin("thinning", "metres_per_radian", metres_per_radian, {0, 1e3});
}

std::vector<std::int64_t> redundantKeyframes(const KeyframeGraph& graph,
                                             const ThinningOptions& options) {
  options.validate();
  std::vector<std::int64_t> removed;
  const auto limit = static_cast<std::size_t>(options.max_keyframes);
  const std::size_t count = graph.vertices().size();
  if (count <= limit) return removed;
  const auto left = static_cast<std::size_t>(std::floor(options.thin_to * options.max_keyframes));
  Crowd crowd(graph, options);
  while (count - removed.size() > left && crowd.removeOne(&removed)) {
  }
  return removed;
}

}  // namespace vins::pose_graph
