#include "vins_estimator/initialization/initializer.h"

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::SyntheticFlight;

InitializerOptions optionsFor(const SyntheticFlight& flight) {
  InitializerOptions options;
  options.imu = {2.0e-3, 1.7e-4, 3.0e-3, 2.0e-5, flight.gravity};
  options.T_bc = flight.T_bc;
  return options;
}

/// Runs over a recording until something is found.
struct Outcome {
  std::optional<Initialization> found;
  std::vector<Event> events;
  double time = 0.0;
};

Outcome runOver(const SyntheticFlight& flight, double begin, double duration) {
  Initializer initializer(optionsFor(flight));
  Outcome run;
  for (const FrameMeasurements& measurements : flight.record(begin, duration)) {
    run.found = initializer.addFrame(std::make_shared<const FrameMeasurements>(measurements));
    for (Event& event : initializer.takeEvents()) run.events.push_back(event);
    run.time = toSeconds(measurements.frame.stamp) - begin;
    if (run.found) break;
  }
  return run;
}

double pathScale(const Initialization& found, const SyntheticFlight& flight) {
  Eigen::Matrix3Xd estimated(3, found.frames.size()), actual(3, found.frames.size());
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    estimated.col(static_cast<Eigen::Index>(i)) = found.frames[i].state.T_wb.position;
    actual.col(static_cast<Eigen::Index>(i)) =
        flight.motion(toSeconds(found.frames[i].features.stamp)).position;
  }
  estimated.colwise() -= Vector3d(estimated.rowwise().mean());
  actual.colwise() -= Vector3d(actual.rowwise().mean());
  return estimated.norm() / actual.norm();
}

bool hasEvent(const std::vector<Event>& events, const std::string& code) {
  for (const Event& event : events) {
    if (event.code == code) return true;
  }
  return false;
}

SyntheticFlight noisyFlight() {
  SyntheticFlight flight = testing::livelyFlight();
  flight.pixel_noise = 0.5;
  flight.accelerometer_bias = {0.15, -0.2, 0.15};
  flight.gyroscope_bias = {0.05, -0.06, 0.06};
  return flight;
}

TEST(Initializer, StartsMovingWithoutNoise) {
  const SyntheticFlight flight = testing::livelyFlight();
  const Outcome run = runOver(flight, 1.0, 5.0);
  ASSERT_TRUE(run.found);
  EXPECT_FALSE(run.found->at_rest);
  EXPECT_LE(run.time, 2.0);
  EXPECT_LE(run.found->frames.size(), 11u);
  EXPECT_NEAR(pathScale(*run.found, flight), 1.0, 5e-3);
  const NavState& newest = run.found->frames.back().state;
  const double t = toSeconds(run.found->frames.back().features.stamp);
  EXPECT_NEAR(t, 1.0 + run.time, 1e-6) << "the newest frame is the last one";
  EXPECT_NEAR(newest.v_w.norm(), flight.velocity(t).norm(), 0.02);
}

TEST(Initializer, WorldIsLevelAndBeginsAtTheFirstFrame) {
  const SyntheticFlight flight = noisyFlight();
  const Outcome run = runOver(flight, 1.0, 5.0);
  ASSERT_TRUE(run.found);
  EXPECT_NEAR(pathScale(*run.found, flight), 1.0, 0.05);
  const InitialFrame& first = run.found->frames.front();
  EXPECT_TRUE(first.state.T_wb.position.isZero(1e-12));
  EXPECT_NEAR(first.state.T_wb.rotation.z(), 0.0, 1e-9) << "no twist about the vertical";
  const Pose truth = flight.motion(toSeconds(first.features.stamp));
  const Vector3d up = first.state.T_wb.rotation.conjugate() * Vector3d::UnitZ();
  EXPECT_LT((up - truth.rotation.conjugate() * Vector3d::UnitZ()).norm(), 0.03);
  EXPECT_LT((first.state.gyroscope_bias - flight.gyroscope_bias).norm(), 5e-3);
}

TEST(Initializer, DoesNotDependOnYawAndPlaceOfTheWorld) {
  const SyntheticFlight flight = noisyFlight();
  const Outcome here = runOver(flight, 1.0, 5.0);
  const Outcome there = runOver(testing::movedWorld(flight, 2.0, {30.0, -20.0, 5.0}), 1.0, 5.0);
  ASSERT_TRUE(here.found && there.found);
  ASSERT_EQ(here.found->frames.size(), there.found->frames.size());
  for (std::size_t i = 0; i < here.found->frames.size(); ++i) {
    const NavState& a = here.found->frames[i].state;
    const NavState& b = there.found->frames[i].state;
    // Accelerations by differences of positions lose digits in the moved world.
    EXPECT_LT((a.T_wb.position - b.T_wb.position).norm(), 1e-3);
    EXPECT_LT(a.T_wb.rotation.angularDistance(b.T_wb.rotation), 1e-4);
    EXPECT_LT((a.v_w - b.v_w).norm(), 1e-3);
  }
}

TEST(Initializer, SurvivesOutliers) {
  SyntheticFlight flight = noisyFlight();
  flight.outlier_share = 0.3;
  const Outcome run = runOver(flight, 1.0, 6.0);
  ASSERT_TRUE(run.found);
  EXPECT_NEAR(pathScale(*run.found, flight), 1.0, 0.05);
}

TEST(Initializer, StartsAtRestWithinASecond) {
  SyntheticFlight flight = noisyFlight();
  flight.motion = [](double) { return testing::livelyMotion(0.0); };
  const Outcome run = runOver(flight, 0.0, 2.0);
  ASSERT_TRUE(run.found);
  EXPECT_TRUE(run.found->at_rest);
  EXPECT_LT(run.time, 1.0);
}

TEST(Initializer, PureRotationDoesNotStart) {
  SyntheticFlight flight = noisyFlight();
  const Pose T_bc = flight.T_bc;
  flight.motion = [T_bc](double t) {
    Pose pose = testing::livelyMotion(2.0 * t);
    pose.position = -(pose.rotation * T_bc.position);
    return pose;
  };
  const Outcome run = runOver(flight, 0.0, 15.0);
  EXPECT_FALSE(run.found);
  EXPECT_TRUE(hasEvent(run.events, "init_little_parallax"));
  EXPECT_LE(run.events.size(), 15u) << "at most one event a second";
}

TEST(Initializer, ConstantVelocityDoesNotStart) {
  SyntheticFlight flight = noisyFlight();
  flight.motion = [](double t) {
    Pose pose = testing::livelyMotion(0.0);
    pose.position = Vector3d(0.0, 0.6 * t, 0.0);
    return pose;
  };
  const Outcome run = runOver(flight, 0.0, 6.0);
  EXPECT_FALSE(run.found);
  EXPECT_TRUE(hasEvent(run.events, "init_little_excitation"));
}

TEST(Initializer, SaysWhenTheImageIsBlank) {
  SyntheticFlight flight = noisyFlight();
  flight.landmarks_w.clear();
  const Outcome run = runOver(flight, 0.0, 3.0);
  EXPECT_FALSE(run.found);
  EXPECT_TRUE(hasEvent(run.events, "init_few_tracks"));
}

TEST(Initializer, FailedAttemptsLeaveNothingBehind) {
  // A blackout of 2 s, then flight: as good as a start after the blackout.
  const SyntheticFlight flight = noisyFlight();
  Initializer initializer(optionsFor(flight));
  auto recording = flight.record(1.0, 8.0);
  std::optional<Initialization> found;
  for (auto& measurements : recording) {
    if (toSeconds(measurements.frame.stamp) < 3.0) measurements.frame.observations.clear();
    if ((found = initializer.addFrame(std::make_shared<const FrameMeasurements>(measurements))))
      break;
  }
  ASSERT_TRUE(found);
  EXPECT_NEAR(pathScale(*found, flight), 1.0, 0.05);
}

TEST(Initializer, ChecksOptions) {
  InitializerOptions options;
  options.max_frames = 2;
  EXPECT_THROW(Initializer{options}, InputError);
}

}  // namespace
}  // namespace vins::estimator
