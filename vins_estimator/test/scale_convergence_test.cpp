#include "vins_estimator/initialization/scale_convergence.h"

#include <gtest/gtest.h>

namespace vins::estimator {
namespace {

constexpr Stamp kSecond = 1'000'000'000;
constexpr Stamp kFrame = kSecond / 20;

TEST(ScaleConvergence, AGoodStartNeedsNone) {
  ScaleConvergence convergence;
  convergence.begin(0, 0.02);
  EXPECT_FALSE(convergence.scaleSigma());
  EXPECT_FALSE(convergence.isDue(100 * kSecond));
  EXPECT_FALSE(convergence.take(0.001));
}

TEST(ScaleConvergence, SolvesAtGrowingIntervalsForTenSeconds) {
  ScaleConvergence convergence;
  convergence.begin(0, 0.2);
  std::vector<Stamp> due;
  for (Stamp stamp = kFrame; stamp < 20 * kSecond; stamp += kFrame) {
    if (convergence.isDue(stamp)) due.push_back(stamp);
  }
  ASSERT_GE(due.size(), 5U);
  EXPECT_EQ(due.front(), kSecond / 2);
  EXPECT_LE(due.back(), 10 * kSecond);
  for (std::size_t i = 2; i < due.size(); ++i) {
    EXPECT_GT(due[i] - due[i - 1], due[i - 1] - due[i - 2]);
  }
  EXPECT_FALSE(convergence.scaleSigma()) << "left to the window";
}

TEST(ScaleConvergence, TakesWhatIsClearlyBetterUntilItHasConverged) {
  ScaleConvergence convergence;
  convergence.begin(0, 0.2);
  EXPECT_FALSE(convergence.take(0.19));
  EXPECT_DOUBLE_EQ(*convergence.scaleSigma(), 0.2);
  EXPECT_TRUE(convergence.take(0.1));
  EXPECT_DOUBLE_EQ(*convergence.scaleSigma(), 0.1);
  EXPECT_TRUE(convergence.take(0.02));
  EXPECT_FALSE(convergence.scaleSigma());
}

}  // namespace
}  // namespace vins::estimator
