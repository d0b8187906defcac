#pragma once

#include <cstdint>
#include <optional>

#include "vins_core/continued_ids.h"
#include "vins_core/keyframe.h"
#include "vins_core/loop_match.h"

namespace vins::pose_graph {

/// Keyframes of an estimator that may have been started again: it counts keyframes, sequences and
/// worlds from 0 anew, which in the graph are others. Old ids of loops are the graph's own
/// everywhere.
class KeyframeNumbering {
 public:
  /// Numbers a keyframe as the graph shall know it. True where the estimator has been started
  /// again: its ids do not rise.
  bool take(Keyframe* keyframe);

  void take(KeyframePoseUpdate* update) const;
  void take(LoopEdge* edge) const;

  /// Numbers the query of a match as the estimator knows it.
  void giveBack(LoopMatch* match) const;

 private:
  std::optional<std::int64_t> last_id_;  ///< as the estimator has given it
  ContinuedIds ids_;
  ContinuedIds sequences_;
  ContinuedIds worlds_;
};

}  // namespace vins::pose_graph
