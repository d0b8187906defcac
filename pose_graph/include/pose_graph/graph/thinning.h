#pragma once

#include <cstdint>
#include <vector>

#include "pose_graph/graph/keyframe_graph.h"

namespace vins::pose_graph {

/// How many keyframes a map may have, and which of them matter.
struct ThinningOptions {
  int max_keyframes = 2000;
  double thin_to = 0.95;  ///< share of max_keyframes that is left, so that it is not always due
  /// Loops that a map may have, for each of max_keyframes: then their ends fit into it, and the
  /// time of an optimization stops growing.
  double loops_per_keyframe = 0.25;
  int newest = 100;                ///< keyframes that stay because they are new
  double metres_per_radian = 2.0;  ///< how far apart a turn sets two keyframes, against distance

  /// Throws InputError naming the option that is out of range.
  void validate() const;
};

/// Ids of keyframes that can leave, once there are more than `max_keyframes`: one after the other
/// that whose nearest neighbour, by position in the map and by the angle between the bodies, is
/// nearest of all. The newest ones stay, and the ends of loops as long as others can leave: that is
/// always, once redundantLoops() have left, but in a map of very many runs that loops have joined
/// (KeyframeGraph::removeKeyframe() then hands their loops on). Keyframes of components that share
/// no frame are not compared. About N sqrt(N) comparisons of N keyframes; the same on every run.
std::vector<std::int64_t> redundantKeyframes(const KeyframeGraph& graph,
                                             const ThinningOptions& options);

}  // namespace vins::pose_graph
