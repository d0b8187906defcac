#include "vins_core/sample_period.h"

#include <gtest/gtest.h>

namespace vins {
namespace {

constexpr Stamp kPeriod = 5'000'000;

TEST(SamplePeriod, IsUnknownBeforeTheSecondSample) {
  SamplePeriod period;
  EXPECT_FALSE(period.seconds());
  period.add(kPeriod);
  EXPECT_FALSE(period.seconds());
  period.add(2 * kPeriod);
  EXPECT_DOUBLE_EQ(period.seconds().value(), 0.005);
}

TEST(SamplePeriod, PassesOverGapsAndInterpolatedSamples) {
  SamplePeriod period;
  for (int i = 0; i < 50; ++i) {
    if (i % 10 == 3) continue;  // lost
    period.add(i * kPeriod);
    if (i % 10 == 7) period.add(i * kPeriod + kPeriod / 3);  // interpolated
  }
  EXPECT_DOUBLE_EQ(period.seconds().value(), 0.005);
}

TEST(SamplePeriod, FollowsAnotherRateAndARestart) {
  SamplePeriod period;
  for (int i = 0; i < 50; ++i) period.add(i * kPeriod);
  for (int i = 0; i < 20; ++i) period.add(2 * i * kPeriod);
  EXPECT_DOUBLE_EQ(period.seconds().value(), 0.01);
}

}  // namespace
}  // namespace vins
