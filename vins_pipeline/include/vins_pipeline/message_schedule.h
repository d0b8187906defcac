#pragma once

#include <cstddef>
#include <vector>

#include "vins_core/time.h"

namespace vins::pipeline {

/// A message of one of several streams.
struct ScheduledMessage {
  Stamp arrival = 0;       ///< [ns]
  std::size_t stream = 0;  ///< index of the stream
  std::size_t index = 0;   ///< of the message in its stream
};

/// The messages of all streams in the order of their arrival; at equal times the order of the
/// streams, and within a stream its own. `arrivals` has the times of each stream [ns].
std::vector<ScheduledMessage> inOrderOfArrival(const std::vector<std::vector<Stamp>>& arrivals);

}  // namespace vins::pipeline
