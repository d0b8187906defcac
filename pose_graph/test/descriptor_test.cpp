#include "pose_graph/place/descriptor.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "random_descriptors.h"

namespace vins::pose_graph {
namespace {

using testing::randomDescriptors;

TEST(HammingDistance, CountsTheBitsThatDiffer) {
  BriefDescriptor a{}, b{};
  EXPECT_EQ(hammingDistance(a, b), 0);
  int expected = 0;
  for (int bit = 0; bit < kDescriptorBits; bit += 7) {
    b[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    EXPECT_EQ(hammingDistance(a, b), ++expected);
    EXPECT_EQ(hammingDistance(b, a), expected);
  }
  b.fill(~std::uint64_t{0});
  EXPECT_EQ(hammingDistance(a, b), kDescriptorBits);
}

TEST(NearestDescriptor, AgreesWithComparingOneByOne) {
  const auto candidates = randomDescriptors(200, 1);
  for (const BriefDescriptor& query : randomDescriptors(20, 2)) {
    std::vector<int> distances;
    for (const auto& candidate : candidates) distances.push_back(hammingDistance(query, candidate));
    const auto nearest = nearestDescriptor(query, candidates.data(), candidates.size());
    const auto best = std::min_element(distances.begin(), distances.end());
    EXPECT_EQ(nearest.index, static_cast<std::size_t>(best - distances.begin()));
    EXPECT_EQ(nearest.distance, *best);
    std::sort(distances.begin(), distances.end());
    EXPECT_EQ(nearest.next_distance, distances[1]);
  }
}

TEST(NearestDescriptor, SaysWhereThereIsNone) {
  const auto one = randomDescriptors(1, 3);
  EXPECT_EQ(nearestDescriptor(one[0], one.data(), 0).distance, kDescriptorBits + 1);
  EXPECT_EQ(nearestDescriptor(one[0], one.data(), 1).distance, 0);
  EXPECT_EQ(nearestDescriptor(one[0], one.data(), 1).next_distance, kDescriptorBits + 1);
}

}  // namespace
}  // namespace vins::pose_graph
