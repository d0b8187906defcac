#include "vins_estimator/initialization/extrinsic_rotation.h"

#include <gtest/gtest.h>

#include "estimator_test_values.h"
#include "synthetic_flight.h"

namespace vins::estimator {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using testing::livelyFlight;
using testing::SyntheticFlight;

const Quaterniond kTrueR_bc = so3::exp(Vector3d(1.2, -0.8, 0.5));

/// Turns of random axes; `wrong` of ten are anything.
std::vector<TurnPair> randomTurns(int count, double td, const Vector3d& bias, int wrong) {
  testing::Random random(5);
  std::vector<TurnPair> pairs;
  for (int i = 0; i < count; ++i) {
    TurnPair pair;
    pair.camera = 0.15 * random.normal3();
    pair.rate_change = 0.8 * random.normal3();
    pair.duration = 0.2 + 0.2 * random.uniform();
    pair.body = kTrueR_bc * pair.camera + pair.duration * bias - td * pair.rate_change;
    if (i % 10 < wrong) pair.camera = 0.3 * random.normal3();
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(HandEye, FindsTheRotationFromNothing) {
  const auto R_bc = fitHandEyeRotation(randomTurns(10, 0.0, Vector3d::Zero(), 0));
  ASSERT_TRUE(R_bc.has_value());
  EXPECT_LT(R_bc->angularDistance(kTrueR_bc), 1e-12);
  EXPECT_FALSE(fitHandEyeRotation({TurnPair()}).has_value());
}

TEST(TurnCalibration, FindsRotationTimeOffsetAndBiasTogether) {
  const Vector3d bias(0.02, -0.01, 0.03);
  TurnCalibration guess;
  guess.R_bc = kTrueR_bc * so3::exp(Vector3d(0.06, -0.05, 0.03));
  const auto found =
      calibrateByTurns(randomTurns(60, 0.03, bias, 2), guess, {0.05, 0.02, 0.05}, 3e-3);
  ASSERT_TRUE(found.has_value());
  // A fifth of the turns is wrong, the rest exact: what is left is what the wrong ones and the
  // priors pull, well within the deviations.
  EXPECT_LT(found->R_bc.angularDistance(kTrueR_bc), 3.0 * found->rotation_sigma);
  EXPECT_LT(found->rotation_sigma, 0.01);
  EXPECT_NEAR(found->td, 0.03, 1e-3);
  EXPECT_LT((found->gyroscope_bias - bias).norm(), 5e-3);
  EXPECT_EQ(found->pairs, 48);
}

TEST(TurnCalibration, LeavesWhatTheTurnsDoNotTell) {
  // All about one axis and at one rate: neither the rotation about it nor td shows.
  std::vector<TurnPair> pairs;
  for (int i = 0; i < 30; ++i) {
    TurnPair pair;
    pair.camera = (0.1 + 0.002 * i) * Vector3d::UnitX();
    pair.body = kTrueR_bc * pair.camera;
    pair.duration = 0.2;
    pairs.push_back(pair);
  }
  TurnCalibration guess;
  guess.R_bc = kTrueR_bc * so3::exp(Vector3d(0.03, 0.0, 0.0));
  guess.td = 0.005;
  const auto found = calibrateByTurns(pairs, guess, {0.05, 0.02, 0.05}, 3e-3);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->td, 0.005, 1e-9);
  EXPECT_NEAR(found->td_sigma, 0.02, 1e-6);
  EXPECT_LT(found->R_bc.angularDistance(guess.R_bc), 1e-6);
  EXPECT_NEAR(found->rotation_sigma, 0.05, 1e-4);
}

TEST(TurnCalibrator, FindsAnUnknownRotationInFlight) {
  SyntheticFlight flight = livelyFlight();
  const auto lively = flight.motion;
  // Turns about three axes, some tenths of a radian.
  flight.motion = [lively](double t) {
    const Vector3d turn(0.4 * std::sin(1.1 * t), 0.35 * std::sin(1.7 * t), 0.3 * std::cos(1.4 * t));
    Pose pose = lively(t);
    pose.rotation = pose.rotation * so3::exp(turn);
    return pose;
  };
  flight.pixel_noise = 0.5;
  flight.gyroscope_bias = {0.01, -0.02, 0.015};
  TurnCalibratorOptions options;
  options.prior.rotation_sigma = 0.0;
  options.pixel_noise = 0.5;
  TurnCalibrator calibrator(options, {});
  std::optional<TurnCalibration> found;
  for (const FrameMeasurements& m : flight.record(0.0, 10.0)) {
    found = calibrator.addFrame(m, 0.0);
    if (found) break;
  }
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(found->R_bc.angularDistance(flight.T_bc.rotation), 0.03);
}

TEST(TurnCalibrator, WaitsAndSaysSoWhereNothingTurns) {
  SyntheticFlight flight = livelyFlight();
  const auto lively = flight.motion;
  flight.motion = [lively](double t) { return Pose(lively(0.0).rotation, lively(t).position); };
  TurnCalibratorOptions options;
  options.prior.rotation_sigma = 0.0;
  TurnCalibrator calibrator(options, {});
  for (const FrameMeasurements& m : flight.record(0.0, 3.0)) {
    EXPECT_FALSE(calibrator.addFrame(m, 0.0).has_value());
  }
  const std::vector<Event> events = calibrator.takeEvents();
  ASSERT_GE(events.size(), 2u);
  EXPECT_LE(events.size(), 3u);
  EXPECT_EQ(events.front().code, "extrinsic_waiting");
}

}  // namespace
}  // namespace vins::estimator
