#pragma once

#include <cstdint>
#include <vector>

#include "pose_graph/graph/keyframe_graph.h"

namespace vins {

/// How many keyframes a map may have, and which of them matter.
struct ThinningOptions {
  int max_keyframes = 2000;
  double thin_to = 0.95;  ///< share of max_keyframes that is left, so that it is not always due
  int newest = 100;       ///< keyframes that stay because they are new
  double metres_per_radian = 2.0;  ///< how far apart a turn sets two keyframes, against distance

  /// Throws InputError naming the option that is out of range.
  void validate() const;
};

/// Ids of keyframes that can leave, once there are more than `max_keyframes`: one after the other
/// that whose nearest neighbour, by position in the map and by the angle between the bodies, is
/// nearest of all. The newest ones stay. The ends of loops stay as long as others can leave: where
/// a place is passed again and again nearly all are such ends, and the map must be bounded all the
/// same (KeyframeGraph::removeKeyframe() hands their loops on). Keyframes of components that share
/// no frame are not compared. About N sqrt(N) comparisons of N keyframes; the same on every run.
std::vector<std::int64_t> redundantKeyframes(const KeyframeGraph& graph,
                                             const ThinningOptions& options);

}  // namespace vins
