#include "pose_graph/loop/loop_detector.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

constexpr std::size_t kPlaces = 100;
constexpr std::size_t kSpan = 40;  // words that an image has

/// A path along a row of words: at `place` an image shows kSpan of them, 10 for each step, so that
/// images four places apart share none.
BagOfWords bagAt(std::size_t place) {
  BagOfWords bag;
  for (std::size_t i = 0; i < kSpan; ++i) {
    bag.push_back({static_cast<std::uint32_t>(10 * place + i), 1.0F / kSpan});
  }
  return bag;
}

class LoopDetectorTest : public ::testing::Test {
 protected:
  LoopDetectorTest() {
    options_.excluded_keyframes = 5;
    options_.excluded_seconds = 0.0;
    options_.min_normalized_score = 0.5;
  }

  LoopDetector detector() const { return {10 * kPlaces + kSpan, options_}; }

  /// Goes on to `place` with the next id, half a second later.
  std::vector<LoopCandidate> visit(LoopDetector* detector, std::size_t place) {
    ++id_;
    return detector->detect(id_, id_ * 500'000'000, bagAt(place));
  }

  /// Places 0 to count - 1 get the ids 1 to count.
  void walk(LoopDetector* detector, std::size_t count) {
    for (std::size_t place = 0; place < count; ++place) {
      EXPECT_TRUE(visit(detector, place).empty()) << place;
    }
  }

  LoopDetectorOptions options_;
  std::int64_t id_ = 0;
};

TEST_F(LoopDetectorTest, FindsAPlaceAgainOnceNeighboursAgree) {
  LoopDetector detector = this->detector();
  walk(&detector, 30);
  EXPECT_TRUE(visit(&detector, 10).empty()) << "nothing agrees yet";
  for (std::size_t place = 11; place < 15; ++place) {
    const auto candidates = visit(&detector, place);
    ASSERT_EQ(candidates.size(), 1u);
    EXPECT_EQ(candidates[0].id, static_cast<std::int64_t>(place) + 1);
    EXPECT_NEAR(candidates[0].score, 1.0, 1e-5);
    // The keyframe before shares three quarters.
    EXPECT_NEAR(candidates[0].normalized_score, 4.0 / 3.0, 1e-5);
    EXPECT_EQ(candidates[0].consistent, static_cast<int>(place) - 10);
    EXPECT_GT(candidates[0].island_score, candidates[0].normalized_score);
  }
}

TEST_F(LoopDetectorTest, AsksForNoAgreementWhereNoneIsWanted) {
  options_.consistent_keyframes = 0;
  LoopDetector detector = this->detector();
  walk(&detector, 30);
  ASSERT_EQ(visit(&detector, 10).size(), 1u);
}

TEST_F(LoopDetectorTest, KeyframesThatLeadElsewhereDoNotAgree) {
  LoopDetector detector = this->detector();
  walk(&detector, 40);
  EXPECT_TRUE(visit(&detector, 10).empty());
  EXPECT_TRUE(visit(&detector, 25).empty()) << "the one before had led to 10";
  EXPECT_TRUE(visit(&detector, 2).empty());
  EXPECT_EQ(visit(&detector, 3).size(), 1u);
}

TEST_F(LoopDetectorTest, HandsOnSeveralPlacesBestFirst) {
  options_.excluded_keyframes = 0;
  options_.min_normalized_score = 0.2;
  options_.consistent_keyframes = 0;
  LoopDetector detector = this->detector();
  for (const std::size_t place : {0U, 1U, 2U}) visit(&detector, place);  // ids 1, 2, 3
  for (const std::size_t place : {50U, 60U, 70U, 80U}) visit(&detector, place);
  visit(&detector, 3);  // 8 shares words with 1 to 3
  for (const std::size_t place : {30U, 40U, 55U, 65U}) visit(&detector, place);
  const auto candidates = visit(&detector, 3);
  ASSERT_EQ(candidates.size(), 2u);
  EXPECT_EQ(candidates[0].id, 3);
  EXPECT_EQ(candidates[1].id, 8);
  EXPECT_GT(candidates[0].island_score, candidates[1].island_score);
}

TEST_F(LoopDetectorTest, LeavesOutWhatIsRecent) {
  options_.consistent_keyframes = 0;
  for (const auto& [keyframes, seconds] : {std::pair(20, 0.0), std::pair(0, 10.1)}) {
    options_.excluded_keyframes = keyframes;
    options_.excluded_seconds = seconds;
    LoopDetector detector = this->detector();
    id_ = 0;
    walk(&detector, 30);
    // The next id is 31: 11 to 30 are the last twenty, and those of the last ten seconds.
    EXPECT_TRUE(visit(&detector, 14).empty()) << keyframes;
    // The next is 32, and 12 is excluded; 11 is place 10.
    const auto candidates = visit(&detector, 10);
    ASSERT_EQ(candidates.size(), 1u) << keyframes;
    EXPECT_EQ(candidates[0].id, 11);
  }
}

TEST_F(LoopDetectorTest, NothingIsRecentAfterARestart) {
  options_.excluded_keyframes = 1000;
  options_.consistent_keyframes = 0;
  LoopDetector detector = this->detector();
  walk(&detector, 30);
  const auto candidates = detector.detect(31, 5, bagAt(20));
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_EQ(candidates[0].id, 21);
}

TEST_F(LoopDetectorTest, FindsPlacesOfAMapAndForgetsRemovedOnes) {
  options_.consistent_keyframes = 0;
  options_.excluded_keyframes = 1000;
  LoopDetector detector = this->detector();
  for (std::int64_t id = 0; id < 20; ++id) detector.add(id, bagAt(static_cast<std::size_t>(id)));
  id_ = 100;
  ASSERT_EQ(visit(&detector, 7).size(), 1u);
  for (std::int64_t id = 4; id < 12; ++id) EXPECT_TRUE(detector.remove(id));
  EXPECT_FALSE(detector.remove(4));
  EXPECT_TRUE(visit(&detector, 7).empty());
  EXPECT_EQ(visit(&detector, 15).size(), 1u);
}

TEST_F(LoopDetectorTest, WordlessImagesFindNothing) {
  options_.consistent_keyframes = 0;
  LoopDetector detector = this->detector();
  walk(&detector, 30);
  EXPECT_TRUE(detector.detect(31, 1'000'000'000'000, {}).empty());
  EXPECT_EQ(detector.detect(32, 1'000'500'000'000, bagAt(5)).size(), 1u);
}

TEST_F(LoopDetectorTest, RefusesBadOptions) {
  options_.island_gap = -1;
  EXPECT_THROW(detector(), InputError);
  options_.island_gap = 3;
  options_.min_score = NAN;
  EXPECT_THROW(detector(), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
