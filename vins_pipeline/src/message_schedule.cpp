#include "vins_pipeline/message_schedule.h"

#include <algorithm>

namespace vins::pipeline {

std::vector<ScheduledMessage> inOrderOfArrival(const std::vector<std::vector<Stamp>>& arrivals) {
  std::vector<ScheduledMessage> messages;
  for (std::size_t stream = 0; stream < arrivals.size(); ++stream) {
    for (std::size_t index = 0; index < arrivals[stream].size(); ++index) {
      messages.push_back({arrivals[stream][index], stream, index});
    }
  }
  std::stable_sort(
      messages.begin(), messages.end(),
      [](const ScheduledMessage& a, const ScheduledMessage& b) { return a.arrival < b.arrival; });
  return messages;
}

}  // namespace vins::pipeline
