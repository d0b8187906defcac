#include "feature_tracker/frame_clock.h"

#include <limits>

#include <gtest/gtest.h>

namespace vins::feature_tracker {
namespace {

TEST(FrameClock, JudgesStamps) {
  FrameClock clock(1.0, 0.0);
  EXPECT_EQ(clock.judge(-1), StampVerdict::kNegative);
  EXPECT_EQ(clock.judge(std::numeric_limits<Stamp>::min()), StampVerdict::kNegative);
  EXPECT_EQ(clock.judge(5'000'000'000), StampVerdict::kFirst);
  EXPECT_TRUE(clock.advance(5'000'000'000));
  EXPECT_EQ(clock.judge(5'000'000'000), StampVerdict::kDuplicate);
  EXPECT_EQ(clock.judge(4'999'999'999), StampVerdict::kLate);
  EXPECT_EQ(clock.judge(4'000'000'001), StampVerdict::kLate);
  EXPECT_EQ(clock.judge(4'000'000'000), StampVerdict::kBackwards);
  EXPECT_EQ(clock.judge(5'050'000'000), StampVerdict::kNext);
  EXPECT_EQ(clock.judge(6'050'000'000), StampVerdict::kGap);
  EXPECT_EQ(clock.judge(std::numeric_limits<Stamp>::max()), StampVerdict::kGap);
}

int dueInTenSeconds(double image_rate, double frequency) {
  FrameClock clock(1.0, frequency);
  int due = 0;
  for (int i = 0; i < static_cast<int>(10.0 * image_rate); ++i) {
    if (clock.advance(1'000'000'000 + toNanoseconds(i / image_rate))) ++due;
  }
  return due;
}

TEST(FrameClock, KeepsTheRate) {
  EXPECT_EQ(dueInTenSeconds(20.0, 0.0), 200);
  EXPECT_EQ(dueInTenSeconds(20.0, 10.0), 100);
  EXPECT_NEAR(dueInTenSeconds(30.0, 20.0), 200, 1);
  EXPECT_EQ(dueInTenSeconds(10.0, 20.0), 100);
}

}  // namespace
}  // namespace vins::feature_tracker
