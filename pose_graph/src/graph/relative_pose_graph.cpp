#include "pose_graph/graph/relative_pose_graph.h"

#include <string>
#include <unordered_map>

#include "vins_core/input_error.h"

namespace vins::pose_graph {

GraphTopology::GraphTopology(const RelativePoseGraph& graph) : links(graph.poses.size()) {
  std::unordered_map<std::int64_t, int> numbers;  // only looked up: its order decides nothing
  for (const GraphPose& pose : graph.poses) {
    if (!numbers.emplace(pose.id, static_cast<int>(numbers.size())).second) {
      throw InputError("pose graph: found pose " + std::to_string(pose.id) + " twice");
    }
  }
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const RelativePoseEdge& edge = graph.edges[k];
    const auto i = numbers.find(edge.from), j = numbers.find(edge.to);
    if (i == numbers.end() || j == numbers.end() || i == j) {
      throw InputError("pose graph: found an edge from pose " + std::to_string(edge.from) + " to " +
                       std::to_string(edge.to) + "; allowed: two different poses of the graph");
    }
    from.push_back(i->second);
    to.push_back(j->second);
    links[static_cast<std::size_t>(i->second)].push_back({static_cast<int>(k), j->second});
    links[static_cast<std::size_t>(j->second)].push_back({static_cast<int>(k), i->second});
  }
}

std::vector<bool> GraphTopology::anchors(const RelativePoseGraph& graph) const {
  const std::size_t count = graph.poses.size();
  std::vector<bool> is_anchor(count), seen(count);
  for (std::size_t start = 0; start < count; ++start) {
    if (seen[start]) continue;
    std::vector<std::size_t> part{start};
    seen[start] = true;
    bool has_fixed = false;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const std::size_t i = part[next];
      is_anchor[i] = graph.poses[i].fixed;
      has_fixed = has_fixed || graph.poses[i].fixed;
      for (const Link& link : links[i]) {
        const auto j = static_cast<std::size_t>(link.other);
        if (seen[j]) continue;
        seen[j] = true;
        part.push_back(j);
      }
    }
    if (!has_fixed) is_anchor[start] = true;
  }
  return is_anchor;
}

}  // namespace vins::pose_graph
