#include "vins_estimator/health/stillness.h"

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::SyntheticFlight;

SyntheticFlight flightWith(const testing::Motion& motion) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.motion = motion;
  flight.pixel_noise = 0.5;
  flight.accelerometer_bias = {0.2, -0.1, 0.2};
  flight.gyroscope_bias = {0.05, -0.05, 0.05};
  return flight;
}

bool isStillAfter(const std::vector<FrameMeasurements>& recording) {
  StillnessDetector detector{StillnessOptions()};
  for (const auto& measurements : recording) {
    detector.addFrame(std::make_shared<const FrameMeasurements>(measurements));
  }
  return detector.isStill();
}

Pose atRest(double) { return testing::livelyMotion(0.0); }

Pose shifted(const Vector3d& shift) {
  Pose pose = atRest(0.0);
  pose.position += shift;
  return pose;
}

TEST(Stillness, SeesRestUnderBiasAndNoise) {
  EXPECT_TRUE(isStillAfter(flightWith(atRest).record(0.0, 0.6)));
}

TEST(Stillness, WaitsForAWholeWindow) {
  EXPECT_FALSE(isStillAfter(flightWith(atRest).record(0.0, 0.4)));
}

TEST(Stillness, SeesRestUnderVibration) {
  auto recording = flightWith(atRest).record(0.0, 0.6);
  for (auto& measurements : recording) {
    for (auto& sample : measurements.imu) {
      // Motors idling at 87 Hz, as strong as on EuRoC's MH_01.
      const double phase = 2.0 * M_PI * 87.0 * toSeconds(sample.stamp);
      sample.acceleration += 1.4 * std::sin(phase) * Vector3d::Ones();
      sample.angular_velocity += 0.05 * std::cos(phase) * Vector3d::Ones();
    }
  }
  EXPECT_TRUE(isStillAfter(recording));
}

TEST(Stillness, IsNotFooledByACruise) {
  // 0.3 m/s at 4 to 9 m: three pixels over half of the window.
  const auto cruise = [](double t) { return shifted(0.3 * t * Vector3d::UnitY()); };
  const auto recording = flightWith(cruise).record(0.0, 0.6);
  EXPECT_FALSE(isStillAfter(recording));
  std::vector<ImuSample> samples;
  for (const auto& m : recording) samples.insert(samples.end(), m.imu.begin(), m.imu.end());
  EXPECT_TRUE(judgeImu(samples, StillnessOptions()).still) << "the IMU alone cannot tell";
}

TEST(Stillness, IsNotFooledByABlankImage) {
  auto recording = flightWith(atRest).record(0.0, 0.6);
  for (auto& measurements : recording) measurements.frame.observations.clear();
  EXPECT_FALSE(isStillAfter(recording));
}

TEST(Stillness, SeesShakingByTheImuAlone) {
  const auto shake = [](double t) {
    return shifted(0.05 * std::sin(12.0 * t) * Vector3d::UnitX());
  };
  std::vector<ImuSample> samples;
  for (const auto& m : flightWith(shake).record(0.0, 0.6)) {
    samples.insert(samples.end(), m.imu.begin(), m.imu.end());
  }
  EXPECT_FALSE(judgeImu(samples, StillnessOptions()).still);
}

TEST(Stillness, MinorityOfMovingObjectsDoesNotMatter) {
  SyntheticFlight flight = flightWith(atRest);
  flight.outlier_share = 0.3;
  EXPECT_TRUE(isStillAfter(flight.record(0.0, 0.6)));
}

TEST(Stillness, ChecksOptions) {
  StillnessOptions options;
  options.min_frames = 3;
  EXPECT_THROW(StillnessDetector{options}, InputError);
}

}  // namespace
}  // namespace vins::estimator
