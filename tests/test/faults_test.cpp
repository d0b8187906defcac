#include "simulation/faults.h"

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

constexpr Stamp kStart = 1600000000000000000;
constexpr Stamp kStep = 5000000;

std::vector<ImuSample> samplesOf(double duration) {
  std::vector<ImuSample> samples;
  for (Stamp t = 0; t <= toNanoseconds(duration); t += kStep) {
    ImuSample sample;
    sample.stamp = kStart + t;
    samples.push_back(sample);
  }
  return samples;
}

TEST(Faults, NoneLeaveTheSamplesAsTheyAre) {
  const auto arrived = withFaults(samplesOf(1.0), kStart, {});
  ASSERT_EQ(arrived.size(), 201u);
  for (const ArrivedSample& a : arrived) EXPECT_EQ(a.arrival, a.sample.stamp);
}

TEST(Faults, AGapIsAsLongAsItSays) {
  ImuFaults faults;
  faults.gaps = {{0.5, 0.55}};
  const auto arrived = withFaults(samplesOf(1.0), kStart, faults);
  EXPECT_EQ(arrived.size(), 201u - 9u);
  Stamp longest = 0;
  for (std::size_t i = 1; i < arrived.size(); ++i) {
    longest = std::max(longest, arrived[i].sample.stamp - arrived[i - 1].sample.stamp);
  }
  EXPECT_EQ(longest, 50000000);
}

TEST(Faults, ArrivalsNeverFallWhateverTheStampsDo) {
  ImuFaults faults = faultBagPreset().imu;
  const auto arrived = withFaults(samplesOf(kFaultBagDuration), kStart, faults);
  int duplicated = 0, reversed = 0, not_finite = 0;
  for (std::size_t i = 1; i < arrived.size(); ++i) {
    EXPECT_LE(arrived[i - 1].arrival, arrived[i].arrival);
    duplicated += arrived[i].sample.stamp == arrived[i - 1].sample.stamp;
    reversed += arrived[i].sample.stamp < arrived[i - 1].sample.stamp;
    not_finite += !arrived[i].sample.isFinite();
  }
  EXPECT_EQ(duplicated, 1);
  EXPECT_EQ(reversed, 1);
  EXPECT_EQ(not_finite, 1);
}

TEST(Faults, ThePresetFitsIntoItsDuration) {
  const Faults faults = faultBagPreset();
  EXPECT_LT(faults.frames.blackouts.back().end_s + 5.0, kFaultBagDuration);
  EXPECT_TRUE(contains(faults.frames.dropped, 32.15));
  EXPECT_FALSE(contains(faults.frames.dropped, 32.2));
}

TEST(Faults, BeyondTheEndNothingHappens) {
  ImuFaults faults;
  faults.not_finite = faults.duplicates = faults.reversals = {5.0};
  EXPECT_EQ(withFaults(samplesOf(1.0), kStart, faults).size(), 201u);
}

TEST(Faults, IntervalsAreReadOrRefused) {
  const TimeInterval interval = parseInterval("--blackout", "12:0.5");
  EXPECT_EQ(interval.begin_s, 12.0);
  EXPECT_EQ(interval.end_s, 12.5);
  for (const char* text : {"", "12", "12:", ":1", "12:0", "-1:2", "a:1", "1:1x", "1:nan"}) {
    EXPECT_THROW(parseInterval("--blackout", text), InputError) << text;
  }
}

}  // namespace
}  // namespace vins::simulation
