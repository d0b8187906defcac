#include "simulation/frame_timing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

TEST(FrameTiming, IsAnExactGridByDefault) {
  const auto instants = frameInstants({}, 2.0, 1);
  ASSERT_EQ(instants.size(), 41u);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    EXPECT_EQ(instants[i].taken_s, static_cast<double>(i) / 20.0);
    EXPECT_EQ(instants[i].stamped_s, instants[i].taken_s);
  }
}

TEST(FrameTiming, LosesTheShareOfImagesThatItIsAskedTo) {
  FrameTiming timing;
  timing.drop_probability = 0.1;
  const auto instants = frameInstants(timing, 500.0, 1);
  EXPECT_NEAR(static_cast<double>(instants.size()), 0.9 * 10001.0, 100.0);
}

TEST(FrameTiming, LosesImagesInBursts) {
  FrameTiming timing;
  timing.burst_probability = 0.01;
  double longest = 0.0;
  const auto instants = frameInstants(timing, 200.0, 1);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    longest = std::max(longest, instants[i].taken_s - instants[i - 1].taken_s);
  }
  EXPECT_GE(longest, 6.0 / 20.0 - 1e-9);
  EXPECT_LT(longest, 1.0);
}

TEST(FrameTiming, ChangesToItsSlowRateForStretches) {
  FrameTiming timing;
  timing.rate = 30.0;
  timing.slow_rate = 15.0;
  int fast = 0, slow = 0;
  const auto instants = frameInstants(timing, 60.0, 1);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const double interval = instants[i].taken_s - instants[i - 1].taken_s;
    fast += std::abs(interval - 1.0 / 30.0) < 1e-6 ? 1 : 0;
    slow += std::abs(interval - 1.0 / 15.0) < 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(fast + slow, static_cast<int>(instants.size()) - 1);
  EXPECT_GT(fast, 300);
  EXPECT_GT(slow, 150);
}

TEST(FrameTiming, StampsJitterAndRise) {
  FrameTiming timing;
  timing.stamp_jitter_s = 0.002;
  double squares = 0.0;
  const auto instants = frameInstants(timing, 100.0, 1);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    EXPECT_GT(instants[i].stamped_s, instants[i - 1].stamped_s);
    squares += std::pow(instants[i].stamped_s - instants[i].taken_s, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(instants.size())), 0.002, 2e-4);
}

TEST(FrameTiming, SeedsRepeatAndDiffer) {
  FrameTiming timing;
  timing.drop_probability = 0.1;
  const auto stampsOf = [&](std::uint64_t seed) {
    std::vector<double> stamps;
    for (const FrameInstant& i : frameInstants(timing, 20.0, seed)) stamps.push_back(i.stamped_s);
    return stamps;
  };
  EXPECT_EQ(stampsOf(3), stampsOf(3));
  EXPECT_NE(stampsOf(3), stampsOf(4));
}

TEST(FrameTiming, RefusesWhatIsOutOfRange) {
  FrameTiming timing;
  timing.drop_probability = 1.0;
  EXPECT_THROW(frameInstants(timing, 1.0, 1), InputError);
  timing = {};
  timing.stamp_jitter_s = NAN;
  EXPECT_THROW(frameInstants(timing, 1.0, 1), InputError);
}

}  // namespace
}  // namespace vins::simulation
