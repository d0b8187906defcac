#include "keyframe_numbering.h"

namespace vins::pose_graph {

bool KeyframeNumbering::take(Keyframe* keyframe) {
  const bool is_new_run = last_id_ && keyframe->id <= *last_id_;
  if (is_new_run) {
    ids_.startAgain();
    sequences_.startAgain();
    worlds_.startAgain();
  }
  last_id_ = keyframe->id;
  keyframe->id = ids_.continued(keyframe->id);
  keyframe->sequence = static_cast<std::uint32_t>(sequences_.continued(keyframe->sequence));
  keyframe->world = static_cast<std::uint32_t>(worlds_.continued(keyframe->world));
  return is_new_run;
}

void KeyframeNumbering::take(KeyframePoseUpdate* update) const {
  update->keyframe_id = ids_.lookUp(update->keyframe_id);
  update->sequence = static_cast<std::uint32_t>(sequences_.lookUp(update->sequence));
}

void KeyframeNumbering::take(LoopEdge* edge) const { edge->query_id = ids_.lookUp(edge->query_id); }

void KeyframeNumbering::giveBack(LoopMatch* match) const {
  match->query_id = ids_.original(match->query_id);
}

}  // namespace vins::pose_graph
