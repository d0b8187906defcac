#include "pose_graph/loop/view_matching.h"

#include <gtest/gtest.h>

#include "random_descriptors.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::randomDescriptors;
using testing::withNoise;

ViewFeature featureOf(const BriefDescriptor& descriptor, std::uint32_t node, int point) {
  ViewFeature feature;
  feature.descriptor = descriptor;
  feature.node = node;
  feature.point = point;
  return feature;
}

/// Features i with the descriptors i, in nodes of ten features each.
KeyframeView viewOf(const std::vector<BriefDescriptor>& descriptors, int first_point) {
  KeyframeView view;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    view.features.push_back(featureOf(descriptors[i], static_cast<std::uint32_t>(i / 10),
                                      first_point < 0 ? -1 : int(i)));
  }
  return view;
}

std::vector<BriefDescriptor> noisy(std::vector<BriefDescriptor> descriptors) {
  std::mt19937_64 random(5);
  for (auto& descriptor : descriptors) descriptor = withNoise(descriptor, 20, &random);
  return descriptors;
}

TEST(MatchViews, FindsEachFeatureAgain) {
  const auto descriptors = randomDescriptors(100, 1);
  const auto matches = matchViews(viewOf(descriptors, 0), viewOf(noisy(descriptors), -1), {});
  ASSERT_EQ(matches.size(), 100u);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    EXPECT_EQ(matches[i].query, static_cast<int>(i));
    EXPECT_EQ(matches[i].old, static_cast<int>(i));
    EXPECT_LE(matches[i].distance, 20);
  }
}

TEST(MatchViews, NeedsADepthInTheQueryOnly) {
  const auto descriptors = randomDescriptors(100, 1);
  EXPECT_TRUE(matchViews(viewOf(descriptors, -1), viewOf(descriptors, 0), {}).empty());
  EXPECT_EQ(matchViews(viewOf(descriptors, 0), viewOf(descriptors, -1), {}).size(), 100u);
}

TEST(MatchViews, ComparesWithinANodeOnly) {
  const auto descriptors = randomDescriptors(20, 1);
  KeyframeView old = viewOf(descriptors, 0);
  for (auto& feature : old.features) feature.node += 1;
  const auto matches = matchViews(viewOf(descriptors, 0), old, {});
  EXPECT_TRUE(matches.empty()) << "features of node 1 are others than those of the old node 1";
  old = viewOf(descriptors, 0);
  old.features.erase(old.features.begin(), old.features.begin() + 10);
  EXPECT_EQ(matchViews(viewOf(descriptors, 0), old, {}).size(), 10u);
}

TEST(MatchViews, LeavesOutWhatIsNotClear) {
  const auto one = randomDescriptors(1, 1)[0];
  BriefDescriptor twenty_off = one, twenty_one_off = one;
  twenty_off[0] ^= 0xfffffU;
  twenty_one_off[1] ^= 0x1fffffU;
  KeyframeView query, old;
  query.features = {featureOf(one, 0, 0)};
  old.features = {featureOf(twenty_off, 0, -1), featureOf(twenty_one_off, 0, -1)};
  EXPECT_TRUE(matchViews(query, old, {}).empty()) << "two old ones look as good";
  MatchOptions options;
  options.max_ratio = 1.0;
  EXPECT_EQ(matchViews(query, old, options).size(), 1u);
  options.max_distance = 5;
  EXPECT_TRUE(matchViews(query, old, options).empty()) << "too far";
}

TEST(MatchViews, GivesAnOldFeatureOnce) {
  const auto one = randomDescriptors(1, 1)[0];
  std::mt19937_64 random(1);
  KeyframeView query, old;
  query.features = {featureOf(withNoise(one, 30, &random), 0, 0), featureOf(one, 0, 1)};
  old.features = {featureOf(one, 0, -1)};
  const auto matches = matchViews(query, old, {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 1);
}

TEST(MatchViews, OfNothingIsNothing) {
  EXPECT_TRUE(matchViews({}, {}, {}).empty());
  MatchOptions options;
  options.max_distance = -1;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
