#include <limits>

#include <gtest/gtest.h>

#include "estimator_test_values.h"
#include "synthetic_flight.h"
#include "vins_core/input_error.h"
#include "vins_estimator/health/continuation.h"
#include "vins_estimator/health/failure_detector.h"
#include "vins_estimator/health/rest_check.h"
#include "vins_estimator/health/track_watch.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::livelyFlight;
using testing::SyntheticFlight;

const Matrix15d kSmall = 1e-4 * Matrix15d::Identity();

TEST(FailureDetector, LetsSoundStatesPass) {
  NavState state;
  state.v_w = {20.0, 3.0, 1.0};
  state.accelerometer_bias.setConstant(0.3);
  EXPECT_FALSE(detectFailure({}, state, state, kSmall).has_value());
}

TEST(FailureDetector, NamesWhatIsWrong) {
  const NavState sound;
  const auto figureOf = [&](const NavState& state, const Matrix15d& covariance) {
    const auto failure = detectFailure({}, sound, state, covariance);
    return failure ? std::string(failure->figure) : std::string();
  };
  NavState state = sound;
  state.accelerometer_bias.x() = 3.0;
  EXPECT_EQ(figureOf(state, kSmall), "bias_m_s2");
  state = sound;
  state.gyroscope_bias.z() = -1.5;
  EXPECT_EQ(figureOf(state, kSmall), "bias_rad_s");
  state = sound;
  state.v_w.y() = 150.0;
  EXPECT_EQ(figureOf(state, kSmall), "speed_m_s");
  state = sound;
  state.T_wb.position.z() = 4.0;
  EXPECT_EQ(figureOf(state, kSmall), "jump_m");
  state = sound;
  state.T_wb.rotation = so3::exp(Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(figureOf(state, kSmall), "turn_rad");
  Matrix15d wide = kSmall;
  wide(kVelocity, kVelocity) = 25.0;
  EXPECT_EQ(figureOf(sound, wide), "sigma_m_s");
  state = sound;
  state.v_w.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(figureOf(state, kSmall), "finite");
  wide(kVelocity, kVelocity) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(figureOf(sound, wide), "sigma_m_s");
}

TEST(FailureDetector, RefusesBoundsThatAreNone) {
  FailureDetectorOptions options;
  options.max_jump = 0.0;
  EXPECT_THROW(options.validate(), InputError);
}

TEST(TrackWatch, TellsLossAndReturnOnce) {
  TrackWatch watch(10);
  EXPECT_FALSE(watch.addFrame(0, 50).has_value());
  const auto lost = watch.addFrame(toNanoseconds(1.0), 9);
  ASSERT_TRUE(lost.has_value());
  EXPECT_EQ(lost->code, "tracking_lost");
  EXPECT_FALSE(watch.addFrame(toNanoseconds(1.5), 0).has_value());
  EXPECT_TRUE(watch.isLost());
  const auto resumed = watch.addFrame(toNanoseconds(2.0), 10);
  ASSERT_TRUE(resumed.has_value());
  EXPECT_EQ(resumed->code, "tracking_resumed");
  EXPECT_DOUBLE_EQ(resumed->figures.back().second, 1.0);
}

/// First states of a flight in a world of their own, as an initialization makes them.
Initialization initializationOf(const SyntheticFlight& flight, double begin, double duration) {
  const Pose T_nw(so3::exp(-1.2 * Vector3d::UnitZ()), Vector3d(-5.0, 2.0, -1.0));
  const Preintegration nothing({}, Vector3d::Zero(), Vector3d::Zero());
  Initialization result;
  for (const FrameMeasurements& m : flight.record(begin, duration)) {
    const double t = toSeconds(m.frame.stamp);
    NavState state;
    state.T_wb = T_nw * flight.motion(t);
    state.v_w = T_nw.rotation * flight.velocity(t);
    result.frames.push_back({m.frame, state, nothing, Vector3d::Zero()});
  }
  result.mean = result.frames.front().state;
  result.sigma.setConstant(1e-3);
  return result;
}

TEST(Continuation, CarriesPositionAndYawOverAReset) {
  const SyntheticFlight flight = livelyFlight();
  NavState last;
  last.T_wb = flight.motion(2.0);
  last.v_w = flight.velocity(2.0);
  Continuation continuation({2e-3, 1.7e-4, 3e-3, 1.9e-5, flight.gravity});
  continuation.start(toNanoseconds(2.0), last, kSmall);
  const std::vector<FrameMeasurements> measurements = flight.record(2.0, 0.8);
  for (std::size_t i = 1; i < measurements.size(); ++i) continuation.addFrame(measurements[i]);
  Initialization initialization = initializationOf(flight, 2.4, 0.4);
  continuation.apply(&initialization);
  for (const InitialFrame& frame : initialization.frames) {
    const double t = toSeconds(frame.features.stamp);
    const Pose truth = flight.motion(t);
    // The IMU has no noise here; what is left is its integration over 0.4 s.
    EXPECT_LT((frame.state.T_wb.position - truth.position).norm(), 0.005);
    EXPECT_LT(frame.state.T_wb.rotation.angularDistance(truth.rotation), 0.002);
    EXPECT_LT((frame.state.v_w - flight.velocity(t)).norm(), 0.01);
  }
  // Nobody saw the way: half a metre after half a second, and some of the yaw.
  EXPECT_GT(initialization.sigma(kPosition), 0.3);
  EXPECT_GT(initialization.sigma(kRotation + 2), 0.005);
  EXPECT_DOUBLE_EQ(initialization.sigma(kRotation), 1e-3);
}

TEST(Continuation, StandsStillWhenTheImuHasBeenAloneForTooLong) {
  const SyntheticFlight flight = livelyFlight();
  NavState last;
  last.T_wb = flight.motion(0.0);
  last.v_w = flight.velocity(0.0);
  Continuation continuation({2e-3, 1.7e-4, 3e-3, 1.9e-5, flight.gravity});
  continuation.start(0, last, kSmall);
  const std::vector<FrameMeasurements> measurements = flight.record(0.0, 4.0);
  for (std::size_t i = 1; i < measurements.size(); ++i) continuation.addFrame(measurements[i]);
  Initialization initialization = initializationOf(flight, 3.5, 0.5);
  continuation.apply(&initialization);
  const Vector3d first = initialization.frames.front().state.T_wb.position;
  EXPECT_LT((first - flight.motion(1.0).position).norm(), 0.15);
  EXPECT_GT(initialization.sigma(kPosition), 3.0);
}

TEST(Continuation, DoesNothingWhereThereIsNothingToGoOnFrom) {
  const SyntheticFlight flight = livelyFlight();
  Continuation continuation{ImuNoise{}};
  Initialization initialization = initializationOf(flight, 1.0, 0.2);
  const NavState before = initialization.frames.front().state;
  continuation.addFrame(flight.record(1.0, 0.2).back());
  continuation.apply(&initialization);
  EXPECT_EQ(minus(initialization.frames.front().state, before).norm(), 0.0);
}

/// Two frames of 60 tracks, of which the second is turned by a rotation vector [px].
Landmarks twoFrames(const Vector3d& turn_px, double noise_px) {
  testing::Random random(9);
  Landmarks landmarks(0.5);
  const Eigen::Quaterniond turn = so3::exp(turn_px / 460.0);
  FeatureFrame first, second;
  for (int i = 0; i < 60; ++i) {
    FeatureObservation feature;
    feature.id = i;
    const Vector3d bearing = Vector3d(random.normal(), random.normal(), 2.0).normalized();
    const auto noisy = [&](const Vector3d& b) {
      return (b + noise_px / 460.0 * random.normal3()).normalized();
    };
    feature.bearing = noisy(bearing);
    first.observations.push_back(feature);
    feature.bearing = noisy(turn * bearing);
    second.observations.push_back(feature);
  }
  landmarks.addFrame(0, first);
  landmarks.addFrame(1, second);
  return landmarks;
}

TEST(RestCheck, SeesACreepBelowTheNoiseOfATrack) {
  EXPECT_TRUE(looksTheSame(twoFrames(Vector3d::Zero(), 0.2), 0, 1));
  // Known to 0.4 px x sqrt(2) / sqrt(60): the bounds lie three deviations from what is to be seen.
  EXPECT_FALSE(looksTheSame(twoFrames({0.0, 0.8, 0.0}, 0.4), 0, 1));
  EXPECT_FALSE(looksTheSame(twoFrames({0.0, 0.0, 1.5}, 0.4), 0, 1));
}

TEST(RestCheck, DoesNotTrustAFewTracks) {
  EXPECT_FALSE(looksTheSame(twoFrames(Vector3d::Zero(), 0.0), 0, 1, 0.3, 61));
}

}  // namespace
}  // namespace vins::estimator
