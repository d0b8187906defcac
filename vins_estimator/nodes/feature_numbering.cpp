#include "feature_numbering.h"

namespace vins::estimator {

bool FeatureNumbering::take(FeatureFrame* frame) {
  const bool is_new_run = last_sequence_ && frame->sequence < *last_sequence_;
  if (is_new_run) ids_.startAgain();
  last_sequence_ = frame->sequence;
  for (FeatureObservation& observation : frame->observations) {
    observation.id = ids_.continued(observation.id);
  }
  return is_new_run;
}

}  // namespace vins::estimator
