#include "feature_numbering.h"

#include <vector>

#include <gtest/gtest.h>

namespace vins::estimator {
namespace {

FeatureFrame frameOf(std::uint32_t sequence, const std::vector<std::int64_t>& ids) {
  FeatureFrame frame;
  frame.sequence = sequence;
  for (const std::int64_t id : ids) {
    frame.observations.emplace_back();
    frame.observations.back().id = id;
  }
  return frame;
}

std::vector<std::int64_t> idsOf(const FeatureFrame& frame) {
  std::vector<std::int64_t> ids;
  for (const FeatureObservation& observation : frame.observations) ids.push_back(observation.id);
  return ids;
}

TEST(FeatureNumbering, LeavesOneRunAsItIs) {
  FeatureNumbering numbering;
  FeatureFrame first = frameOf(0, {0, 1, 2}), second = frameOf(3, {1, 7});
  EXPECT_FALSE(numbering.take(&first));
  EXPECT_FALSE(numbering.take(&second)) << "frames left out are no new start";
  EXPECT_EQ(idsOf(first), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(idsOf(second), (std::vector<std::int64_t>{1, 7}));
}

TEST(FeatureNumbering, TracksOfANewRunAreNotThoseOfTheOldOne) {
  FeatureNumbering numbering;
  FeatureFrame old = frameOf(200, {5, 99}), frame = frameOf(0, {0, 5}), next = frameOf(1, {5, 6});
  numbering.take(&old);
  EXPECT_TRUE(numbering.take(&frame));
  EXPECT_EQ(idsOf(frame), (std::vector<std::int64_t>{100, 105}));
  EXPECT_FALSE(numbering.take(&next));
  EXPECT_EQ(idsOf(next), (std::vector<std::int64_t>{105, 106})) << "the same track goes on";
}

}  // namespace
}  // namespace vins::estimator
