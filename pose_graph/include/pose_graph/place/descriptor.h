#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vins::pose_graph {

/// A binary descriptor of 256 bits: bit i is bit i % 64 of word i / 64.
using BriefDescriptor = std::array<std::uint64_t, 4>;

constexpr int kDescriptorBits = 256;

/// Number of bits in which two descriptors differ, 0 to 256.
int hammingDistance(const BriefDescriptor& a, const BriefDescriptor& b);

/// The best of a list of descriptors, and how good the second best is.
struct NearestDescriptor {
  std::size_t index = 0;                    ///< of the nearest; the first of equally near ones
  int distance = kDescriptorBits + 1;       ///< to the nearest; 257 where the list is empty
  int next_distance = kDescriptorBits + 1;  ///< to the second nearest; 257 where there is none
};

/// The nearest of `count` descriptors that lie in a row, by Hamming distance. The fast way to
/// compare many: one call, with the processor's instruction for counting bits where it has one.
NearestDescriptor nearestDescriptor(const BriefDescriptor& query, const BriefDescriptor* candidates,
                                    std::size_t count);

}  // namespace vins::pose_graph
