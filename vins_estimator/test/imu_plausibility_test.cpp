#include "vins_estimator/health/imu_plausibility.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

constexpr Stamp kMs = 1'000'000;
constexpr Stamp kStart = 1'600'000'000'000 * kMs;

/// A hand-held rig for five seconds at 200 Hz and 20 images a second, upright, x up.
std::vector<Event> run(const std::function<void(ImuSample*)>& change, Stamp image_shift = 0) {
  ImuPlausibilityOptions options;
  // The camera looks along body z; its y points down, along -x of the body.
  Eigen::Matrix3d R_bc;
  R_bc << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  options.R_bc = Eigen::Quaterniond(R_bc);
  ImuPlausibility plausibility(options);
  for (int i = 0; i <= 1000; ++i) {
    const double wave = std::sin(0.05 * i);
    ImuSample sample{kStart + i * 5 * kMs, {9.81 + wave, 0.5 * wave, 0.3}, {0.8 * wave, 0.4, 0.0}};
    change(&sample);
    plausibility.addImu(sample);
    if (i % 10 == 0) plausibility.addImage(kStart + i * 5 * kMs + image_shift);
  }
  return plausibility.takeEvents();
}

/// The only event's code; "none", or "several".
std::string codeOf(const std::vector<Event>& events) {
  if (events.empty()) return "none";
  return events.size() == 1 ? events.front().code : "several";
}

TEST(ImuPlausibility, IsSilentAboutSoundData) {
  EXPECT_EQ(codeOf(run([](ImuSample*) {})), "none");
}

TEST(ImuPlausibility, NamesTheAccelerometersFaults) {
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->acceleration /= 9.81; })), "imu_accelerometer_units");
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->acceleration.setZero(); })),
            "imu_accelerometer_silent");
  EXPECT_EQ(codeOf(run([](ImuSample* s) {
              s->acceleration = {9.81, 0.0, 0.0};
            })),
            "imu_accelerometer_silent");
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->acceleration.x() -= 9.81; })), "imu_no_gravity");
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->acceleration *= -1.0; })), "imu_upside_down");
}

TEST(ImuPlausibility, NamesTheGyroscopesFaults) {
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->angular_velocity *= 57.3; })), "imu_gyroscope_units");
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->angular_velocity.setZero(); })),
            "imu_gyroscope_silent");
}

TEST(ImuPlausibility, NamesClocksThatAreApart) {
  for (const Stamp hours : {-1, 1}) {
    const std::vector<Event> events = run([](ImuSample*) {}, hours * 3600'000 * kMs);
    ASSERT_EQ(codeOf(events), "clocks_apart");
    EXPECT_NEAR(events[0].figures[0].second, 3600.0 * static_cast<double>(hours), 0.1);
  }
  EXPECT_EQ(codeOf(run([](ImuSample* s) { s->stamp = 0; })), "clocks_apart");
  EXPECT_EQ(codeOf(run([](ImuSample*) {}, 2000 * kMs)), "none");
}

TEST(ImuPlausibility, AnEndedStreamIsNoClockApart) {
  ImuPlausibility plausibility({});
  for (int i = 0; i < 200; ++i) {
    plausibility.addImu({kStart + i * 5 * kMs, {9.81, 0.1 * (i % 3), 0.0}, {0.01 * i, 0.0, 0.0}});
  }
  for (int i = 0; i < 1000; ++i) plausibility.addImage(kStart + i * 50 * kMs);
  EXPECT_TRUE(plausibility.takeEvents().empty());
}

}  // namespace
}  // namespace vins::estimator
