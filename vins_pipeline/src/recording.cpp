#include "vins_pipeline/recording.h"

#include <sstream>

#include "vins_core/input_error.h"

namespace vins::pipeline {

void RecordingSelection::validate() const {
  std::ostringstream message;
  if (image_topics.empty()) message << "recording: no image topic is selected";
  if (!(start >= 0.0 && start < 1e9)) {
    message << "start: found " << start << "; allowed: at least 0 s";
  } else if (duration && !(*duration > 0.0 && *duration < 1e9)) {
    message << "duration: found " << *duration << "; allowed: above 0 s";
  }
  if (!message.str().empty()) throw InputError(message.str());
}

}  // namespace vins::pipeline
