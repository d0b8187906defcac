#pragma once

#include <random>
#include <vector>

#include "pose_graph/place/descriptor.h"

namespace vins::pose_graph::testing {

inline BriefDescriptor randomDescriptor(std::mt19937_64* random) {
  BriefDescriptor descriptor;
  for (auto& word : descriptor) word = (*random)();
  return descriptor;
}

inline std::vector<BriefDescriptor> randomDescriptors(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<BriefDescriptor> descriptors(count);
  for (auto& descriptor : descriptors) descriptor = randomDescriptor(&random);
  return descriptors;
}

/// The descriptor with some bits (not always different ones) turned.
inline BriefDescriptor withNoise(BriefDescriptor descriptor, int bits, std::mt19937_64* random) {
  for (int i = 0; i < bits; ++i) {
    const std::uint64_t bit = (*random)() % kDescriptorBits;
    descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

}  // namespace vins::pose_graph::testing
