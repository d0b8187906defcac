#include "pose_graph/loop/odometry_gate.h"

#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <utility>
#include <vector>

#include "vins_core/heading.h"
#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// A keyframe and how far it is from the start [m].
using Reached = std::pair<double, std::int64_t>;

using Neighbours = std::map<std::int64_t, std::vector<Reached>>;

Neighbours neighboursIn(const KeyframeGraph& graph) {
  Neighbours neighbours;
  const auto connect = [&neighbours](std::int64_t a, std::int64_t b, double length) {
    neighbours[a].emplace_back(length, b);
    neighbours[b].emplace_back(length, a);
  };
  const auto& vertices = graph.vertices();
  for (const auto sequence : graph.sequences()) {
    const std::vector<std::int64_t>& ids = graph.keyframesOf(sequence);
    for (std::size_t i = 1; i < ids.size(); ++i) {
      const double length = vertices.at(ids[i]).travelled - vertices.at(ids[i - 1]).travelled;
      connect(ids[i - 1], ids[i], length);
    }
  }
  for (const LoopEdge& loop : graph.loops()) connect(loop.query_id, loop.old_id, 0.0);
  return neighbours;
}

}  // namespace

void OdometryGateOptions::validate() const {
  const char* const owner = "odometry gate";
  requireWithin(owner, "position_slack", position_slack, {0.0, 1e6});
  requireWithin(owner, "loop_max_drift", position_share, {0.0, 1e6});
  requireWithin(owner, "yaw_slack", yaw_slack, {0.0, 180.0});
  requireWithin(owner, "yaw_rate", yaw_rate, {0.0, 1e6});
}

std::optional<double> wayBetween(const KeyframeGraph& graph, std::int64_t a, std::int64_t b) {
  if (graph.vertices().count(a) == 0 || graph.vertices().count(b) == 0) return std::nullopt;
  const Neighbours neighbours = neighboursIn(graph);
  std::map<std::int64_t, double> shortest;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  open.emplace(0.0, a);
  while (!open.empty()) {
    const auto [way, id] = open.top();
    open.pop();
    if (id == b) return way;
    if (!shortest.emplace(id, way).second) continue;
    const auto found = neighbours.find(id);
    if (found == neighbours.end()) continue;
    for (const auto& [length, next] : found->second) {
      if (shortest.count(next) == 0) open.emplace(way + length, next);
    }
  }
  return std::nullopt;
}

std::optional<OdometryComparison> compareWithOdometry(const OdometryGateOptions& options,
                                                      const KeyframeGraph& graph,
                                                      std::int64_t query_id, std::int64_t old_id,
                                                      const Pose& T_old_query) {
  const std::optional<double> way = wayBetween(graph, query_id, old_id);
  if (!way) return std::nullopt;
  const Pose by_loop = graph.vertices().at(old_id).T_mb * T_old_query;
  const Pose& by_graph = graph.vertices().at(query_id).T_mb;
  OdometryComparison comparison;
  comparison.way = *way;
  comparison.position_error = (by_loop.position - by_graph.position).norm();
  comparison.yaw_error = std::abs(yawOf(by_loop.rotation * by_graph.rotation.conjugate()));
  const double position_limit = options.position_slack + options.position_share * *way;
  const double yaw_limit = (options.yaw_slack + options.yaw_rate * *way) * kDegree;
  comparison.is_plausible =
      comparison.position_error <= position_limit && comparison.yaw_error <= yaw_limit;
  return comparison;
}

}  // namespace vins::pose_graph
