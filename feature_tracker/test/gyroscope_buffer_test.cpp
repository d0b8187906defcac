#include "feature_tracker/gyroscope_buffer.h"

#include <gtest/gtest.h>

namespace vins::feature_tracker {
namespace {

constexpr Stamp kMillisecond = 1'000'000;

ImuSample sampleAt(Stamp stamp) {
  ImuSample sample;
  sample.stamp = stamp;
  return sample;
}

/// Samples at 5 ms from 0 to `last` [ms].
GyroscopeBuffer filled(double td, int last) {
  GyroscopeBuffer buffer(td);
  for (int t = 0; t <= last; t += 5) buffer.add(sampleAt(t * kMillisecond));
  return buffer;
}

TEST(GyroscopeBuffer, HandsOutEachSampleOnceUpToTheImage) {
  GyroscopeBuffer buffer = filled(0.0, 100);
  EXPECT_EQ(buffer.takeUntil(50 * kMillisecond).size(), 11U);
  EXPECT_EQ(buffer.takeUntil(50 * kMillisecond).size(), 0U);
  const auto rest = buffer.takeUntil(100 * kMillisecond);
  ASSERT_EQ(rest.size(), 10U);
  EXPECT_EQ(rest.front().stamp, 55 * kMillisecond);
}

TEST(GyroscopeBuffer, PutsSamplesOnTheCamerasClock) {
  // The camera's clock is 20 ms behind the IMU's: its image at 50 ms was taken at 70 ms.
  GyroscopeBuffer buffer = filled(0.02, 65);
  EXPECT_FALSE(buffer.reaches(50 * kMillisecond));
  buffer.add(sampleAt(70 * kMillisecond));
  EXPECT_TRUE(buffer.reaches(50 * kMillisecond));
  const auto samples = buffer.takeUntil(50 * kMillisecond);
  ASSERT_EQ(samples.size(), 15U);
  EXPECT_EQ(samples.back().stamp, 50 * kMillisecond);
}

TEST(GyroscopeBuffer, ARestartedRecordingForgetsTheOldSamples) {
  GyroscopeBuffer buffer(0.0);
  buffer.add(sampleAt(5000 * kMillisecond));
  buffer.add(sampleAt(4500 * kMillisecond));  // disorder, not a restart
  EXPECT_EQ(buffer.takeUntil(6000 * kMillisecond).size(), 2U);
  buffer.add(sampleAt(5000 * kMillisecond));
  buffer.add(sampleAt(100 * kMillisecond));
  EXPECT_FALSE(buffer.reaches(200 * kMillisecond));
  ASSERT_EQ(buffer.takeUntil(200 * kMillisecond).size(), 1U);
}

TEST(GyroscopeBuffer, MemoryIsBounded) {
  GyroscopeBuffer buffer(0.0);
  for (int i = 0; i < 30000; ++i) buffer.add(sampleAt(i));
  EXPECT_EQ(buffer.takeUntil(30000).size(), 10000U);
}

}  // namespace
}  // namespace vins::feature_tracker
