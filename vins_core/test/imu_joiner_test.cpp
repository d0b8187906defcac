#include "vins_core/imu_joiner.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins {
namespace {

using Eigen::Vector3d;

constexpr Stamp kStart = 1'600'000'000'000'000'000;

Stamp at(double seconds) { return kStart + toNanoseconds(seconds); }

/// Linear in time, so that interpolation must give it exactly.
Vector3d acceleration(double t) { return {1.0 + 2.0 * t, -3.0 * t, 9.81}; }
Vector3d rate(double t) { return {std::sin(t), std::cos(t), 0.1}; }

std::vector<ImuSample> takeAll(ImuJoiner* joiner) {
  std::vector<ImuSample> samples;
  while (const auto sample = joiner->next()) samples.push_back(*sample);
  return samples;
}

/// Feeds both sensors by their stamps for `seconds`, and returns what comes out.
std::vector<ImuSample> run(double gyroscope_rate, double accelerometer_rate, double seconds,
                           ImuJoiner* joiner) {
  std::vector<ImuSample> samples;
  int i = 0, k = 0;
  while (true) {
    const double gyroscope = i / gyroscope_rate;
    const double accelerometer = 0.0007 + k / accelerometer_rate;
    if (std::min(gyroscope, accelerometer) > seconds) return samples;
    if (gyroscope < accelerometer) {
      joiner->addGyroscope(at(gyroscope), rate(gyroscope));
      ++i;
    } else {
      joiner->addAccelerometer(at(accelerometer), acceleration(accelerometer));
      ++k;
    }
    for (const ImuSample& sample : takeAll(joiner)) samples.push_back(sample);
  }
}

std::vector<Event> eventsOf(ImuJoiner* joiner, const std::string& code) {
  std::vector<Event> events;
  for (const Event& event : joiner->takeEvents()) {
    if (event.code == code) events.push_back(event);
  }
  return events;
}

TEST(ImuJoiner, InterpolatesTheAccelerationAtEveryStampOfTheGyroscope) {
  for (const double gyroscope_rate : {63.0, 200.0, 250.0, 400.0}) {
    for (const double accelerometer_rate : {63.0, 200.0, 250.0, 400.0}) {
      ImuJoiner joiner;
      const auto samples = run(gyroscope_rate, accelerometer_rate, 5.0, &joiner);
      // All but those before the first and behind the last acceleration.
      EXPECT_GT(samples.size(), gyroscope_rate * (5.0 - 2.0 / accelerometer_rate) - 2.0);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t = toSeconds(samples[i].stamp - kStart);
        EXPECT_EQ(samples[i].angular_velocity, rate((i + 1) / gyroscope_rate)) << t;
        // Stamps are whole nanoseconds.
        EXPECT_LT((samples[i].acceleration - acceleration(t)).norm(), 2e-8) << t;
      }
      EXPECT_TRUE(joiner.takeEvents().empty());
    }
  }
}

TEST(ImuJoiner, ExtrapolatesNeitherBeforeTheFirstNorBehindTheLastAcceleration) {
  ImuJoiner joiner;
  for (int i = 0; i <= 10; ++i) joiner.addGyroscope(at(0.01 * i), rate(0.01 * i));
  EXPECT_TRUE(takeAll(&joiner).empty());
  joiner.addAccelerometer(at(0.035), acceleration(0.035));
  EXPECT_TRUE(takeAll(&joiner).empty());
  joiner.addAccelerometer(at(0.070), acceleration(0.070));
  const auto samples = takeAll(&joiner);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples.front().stamp, at(0.04));
  EXPECT_EQ(samples.back().stamp, at(0.07));
  EXPECT_EQ(samples.back().acceleration, acceleration(0.070));
}

TEST(ImuJoiner, DoesNotDependOnWhenSamplesArrive) {
  ImuJoiner in_order, late;
  const auto expected = run(200.0, 63.0, 0.8, &in_order);
  for (int i = 0; i <= 160; ++i) late.addGyroscope(at(i / 200.0), rate(i / 200.0));
  for (int k = 0; 0.0007 + k / 63.0 <= 0.8; ++k) {
    late.addAccelerometer(at(0.0007 + k / 63.0), acceleration(0.0007 + k / 63.0));
  }
  const auto samples = takeAll(&late);
  ASSERT_EQ(samples.size(), expected.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].stamp, expected[i].stamp);
    EXPECT_EQ(samples[i].acceleration, expected[i].acceleration);
  }
}

TEST(ImuJoiner, LeavesOutWhatIsDoubleOutOfOrderOrNotFinite) {
  ImuJoiner joiner;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  joiner.addAccelerometer(at(0.0), acceleration(0.0));
  joiner.addGyroscope(at(0.01), rate(0.01));
  joiner.addGyroscope(at(0.01), rate(5.0));
  joiner.addGyroscope(at(0.005), rate(5.0));
  joiner.addGyroscope(at(0.012), {nan, 0.0, 0.0});
  joiner.addAccelerometer(at(0.02), acceleration(0.02));
  joiner.addAccelerometer(at(0.02), acceleration(7.0));
  joiner.addAccelerometer(at(0.015), acceleration(7.0));
  joiner.addAccelerometer(at(0.025), {0.0, nan, 0.0});
  joiner.addGyroscope(at(0.015), rate(0.015));
  const auto samples = takeAll(&joiner);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].angular_velocity, rate(0.01));
  EXPECT_LT((samples[1].acceleration - acceleration(0.015)).norm(), 1e-12);
  EXPECT_EQ(eventsOf(&joiner, "imu_disorder").size(), 1u);
}

TEST(ImuJoiner, ASilentAccelerometerIsToldAndNothingGrows) {
  ImuJoiner joiner;
  run(200.0, 63.0, 1.0, &joiner);
  int told = 0;
  std::size_t most = 0;
  for (int i = 201; i <= 200 * 60; ++i) {
    joiner.addGyroscope(at(i / 200.0), rate(i / 200.0));
    EXPECT_FALSE(joiner.next()) << "extrapolated";
    most = std::max(most, joiner.sampleCount());
    for (const Event& event : eventsOf(&joiner, "imu_accelerometer_missing")) {
      if (++told == 1) {
        EXPECT_NEAR(event.figures[0].second, 1.0, 0.05);
      }
      EXPECT_NE(event.text.find("accel_topic"), std::string::npos);
    }
  }
  EXPECT_EQ(told, 6) << "every ten seconds";
  EXPECT_LT(most, 220u) << "a second of samples";
}

TEST(ImuJoiner, AnAccelerometerThatNeverCameIsTold) {
  ImuJoiner joiner;
  for (int i = 0; i <= 210; ++i) joiner.addGyroscope(at(i / 200.0), rate(0.0));
  EXPECT_EQ(eventsOf(&joiner, "imu_accelerometer_missing").size(), 1u);
}

TEST(ImuJoiner, ASilentGyroscopeIsToldAndNothingGrows) {
  ImuJoiner joiner;
  for (int k = 0; k <= 250 * 60; ++k) joiner.addAccelerometer(at(k / 250.0), acceleration(0.0));
  EXPECT_EQ(eventsOf(&joiner, "imu_gyroscope_missing").size(), 6u);
  EXPECT_LE(joiner.sampleCount(), 2501u) << "ten seconds of samples";
}

TEST(ImuJoiner, AGapOfTheAccelerometerIsNotBridged) {
  ImuJoiner joiner;
  joiner.addAccelerometer(at(0.0), acceleration(0.0));
  for (int i = 1; i < 60; ++i) joiner.addGyroscope(at(0.005 * i), rate(0.0));
  joiner.addAccelerometer(at(0.2), acceleration(0.2));
  joiner.addAccelerometer(at(0.25), acceleration(0.25));
  const auto samples = takeAll(&joiner);
  ASSERT_FALSE(samples.empty());
  EXPECT_EQ(samples.front().stamp, at(0.2));
  EXPECT_EQ(samples.back().stamp, at(0.25));
}

TEST(ImuJoiner, GoesOnWhereARecordingIsPlayedAgain) {
  ImuJoiner joiner;
  const auto first = run(200.0, 63.0, 5.0, &joiner);
  const auto second = run(200.0, 63.0, 5.0, &joiner);
  ASSERT_EQ(second.size(), first.size());
  EXPECT_EQ(second.front().stamp, first.front().stamp);
  EXPECT_EQ(second.back().acceleration, first.back().acceleration);
}

TEST(ImuJoiner, RefusesOptionsOutOfRange) {
  ImuJoinerOptions options;
  options.max_interval = 0.0;
  EXPECT_THROW(ImuJoiner joiner(options), InputError);
}

}  // namespace
}  // namespace vins
