#include "pose_graph/place/descriptor.h"

// The same function once with and once without the instruction, chosen when the program is loaded:
// it is fast on today's processors, and runs on all. Others than x86 count bits well by default.
#if defined(__x86_64__) && defined(__gnu_linux__)
#define VINS_COUNTS_BITS __attribute__((target_clones("popcnt", "default")))
#else
#define VINS_COUNTS_BITS
#endif

namespace vins::pose_graph {

VINS_COUNTS_BITS int hammingDistance(const BriefDescriptor& a, const BriefDescriptor& b) {
  int distance = 0;
  for (int i = 0; i < 4; ++i) distance += __builtin_popcountll(a[i] ^ b[i]);
  return distance;
}

VINS_COUNTS_BITS NearestDescriptor nearestDescriptor(const BriefDescriptor& query,
                                                     const BriefDescriptor* candidates,
                                                     std::size_t count) {
  NearestDescriptor nearest;
  for (std::size_t i = 0; i < count; ++i) {
    int distance = 0;
    for (int word = 0; word < 4; ++word) {
      distance += __builtin_popcountll(query[word] ^ candidates[i][word]);
    }
    if (distance < nearest.distance) {
      nearest.next_distance = nearest.distance;
      nearest.distance = distance;
      nearest.index = i;
    } else if (distance < nearest.next_distance) {
      nearest.next_distance = distance;
    }
  }
  return nearest;
}

}  // namespace vins::pose_graph
