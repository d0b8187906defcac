#include "vins_estimator/estimator.h"

#include <set>

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::livelyFlight;
using testing::SyntheticFlight;

EstimatorOptions optionsFor(const SyntheticFlight& flight) {
  EstimatorOptions options;
  options.imu = {2.0e-3, 1.7e-4, 3.0e-3, 1.9e-5, flight.gravity};
  options.T_bc = flight.T_bc;
  return options;
}

/// A lively flight that stays before its wall for long.
SyntheticFlight longFlight() {
  SyntheticFlight flight = livelyFlight();
  flight.motion = [](double t) {
    Pose pose = testing::livelyMotion(t);
    pose.position.y() -= 0.6 * t;  // sways instead of passing by
    return pose;
  };
  flight.pixel_noise = 0.3;
  return flight;
}

struct Span {
  double begin, end;
  bool has(double t) const { return t >= begin && t < end; }
};

/// Lets the estimator follow a flight, with the IMU silent over `silence` and the images dark over
/// `darkness`.
class Follower {
 public:
  Follower(const SyntheticFlight& flight, const EstimatorOptions& options)
      : flight_(flight), estimator_(options) {}

  std::vector<EstimatorResult> fly(double begin, double end, Span silence = {0, 0},
                                   Span darkness = {0, 0}, double shift = 0.0) {
    std::vector<EstimatorResult> results;
    for (int k = 0; begin + 0.005 * k <= end; ++k) {
      const double t = begin + 0.005 * k;
      if (!silence.has(t)) {
        ImuSample sample = flight_.imuAt(t);
        sample.stamp += toNanoseconds(shift);
        estimator_.addImu(sample);
      }
      if (k % 10 == 0) {
        FeatureFrame frame = flight_.frameAt(t);
        frame.stamp += toNanoseconds(shift);
        if (darkness.has(t)) frame.observations.clear();
        estimator_.addFrame(frame);
      }
      while (auto result = estimator_.process()) results.push_back(std::move(*result));
    }
    return results;
  }

  Estimator& estimator() { return estimator_; }

 private:
  const SyntheticFlight& flight_;
  Estimator estimator_;
};

bool hasEvent(const std::vector<EstimatorResult>& results, const std::string& code) {
  for (const EstimatorResult& result : results) {
    for (const Event& event : result.events) {
      if (event.code == code) return true;
    }
  }
  return false;
}

/// Distance flown between two odometries, against the truth.
double errorBetween(const SyntheticFlight& flight, const Odometry& a, const Odometry& b) {
  const Pose estimated = a.state.T_wb.inverse() * b.state.T_wb;
  const Pose truth =
      flight.motion(toSeconds(a.stamp)).inverse() * flight.motion(toSeconds(b.stamp));
  return (estimated.position - truth.position).norm();
}

const Odometry* firstOf(const std::vector<EstimatorResult>& results, std::uint32_t sequence) {
  for (const EstimatorResult& result : results) {
    if (result.odometry && result.odometry->sequence == sequence) return &*result.odometry;
  }
  return nullptr;
}

const Odometry* lastOf(const std::vector<EstimatorResult>& results, std::uint32_t sequence) {
  const Odometry* last = nullptr;
  for (const EstimatorResult& result : results) {
    if (result.odometry && result.odometry->sequence == sequence) last = &*result.odometry;
  }
  return last;
}

/// Keyframe::world of a sequence's keyframes.
std::set<std::uint32_t> worldsOf(const std::vector<EstimatorResult>& results,
                                 std::uint32_t sequence) {
  std::set<std::uint32_t> worlds;
  for (const EstimatorResult& result : results) {
    for (const Keyframe& keyframe : result.keyframes) {
      if (keyframe.sequence == sequence) worlds.insert(keyframe.world);
    }
  }
  return worlds;
}

TEST(Estimator, FollowsAFlightWithCovariance) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  const auto results = follower.fly(1.0, 7.0);
  const Odometry* first = firstOf(results, 0);
  const Odometry* last = lastOf(results, 0);
  ASSERT_NE(first, nullptr);
  EXPECT_LT(toSeconds(first->stamp), 4.5);
  EXPECT_LT(errorBetween(flight, *first, *last), 0.05);
  EXPECT_GT(last->covariance.diagonal().minCoeff(), 0.0);
  EXPECT_FALSE(hasEvent(results, "reset"));
}

TEST(Estimator, CrossesAShortSilenceOfTheImu) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  const auto results = follower.fly(1.0, 9.0, {6.0, 6.2});
  EXPECT_TRUE(hasEvent(results, "imu_gap"));
  EXPECT_FALSE(hasEvent(results, "reset"));
  EXPECT_LT(errorBetween(flight, *firstOf(results, 0), *lastOf(results, 0)), 0.05);
}

TEST(Estimator, GoesOnFromTheLastCredibleStateAfterALongSilence) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  const auto results = follower.fly(1.0, 14.0, {6.0, 6.7});
  EXPECT_TRUE(hasEvent(results, "reset"));
  const Odometry* before = lastOf(results, 0);
  const Odometry* after = firstOf(results, 1);
  ASSERT_NE(before, nullptr);
  ASSERT_NE(after, nullptr);
  EXPECT_NE(after->sequence, before->sequence);
  // It has not been at the origin since: the body sways within a metre, the guess within two.
  EXPECT_LT(errorBetween(flight, *before, *after), 1.5);
  // And it says how little it knows of the way: more than before by far.
  EXPECT_GT(std::sqrt(after->covariance(0, 0)), 10.0 * std::sqrt(before->covariance(0, 0)));
  EXPECT_GT(std::sqrt(after->covariance(0, 0)), 0.3);
  EXPECT_EQ(worldsOf(results, 0), std::set<std::uint32_t>{0});
  EXPECT_EQ(worldsOf(results, 1), std::set<std::uint32_t>{0}) << "the frame is still the same";
}

TEST(Estimator, FliesThroughADarkSecond) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  const auto results = follower.fly(1.0, 9.0, {0, 0}, {6.0, 7.0});
  EXPECT_TRUE(hasEvent(results, "tracking_lost"));
  EXPECT_TRUE(hasEvent(results, "tracking_resumed"));
  EXPECT_FALSE(hasEvent(results, "reset"));
  EXPECT_LT(errorBetween(flight, *firstOf(results, 0), *lastOf(results, 0)), 0.1);
  std::size_t odometries = 0;
  for (const EstimatorResult& result : results) odometries += result.odometry.has_value();
  EXPECT_GT(odometries, results.size() - 80u);  // none is missing once it has begun
}

TEST(Estimator, ARecordingStartedAgainIsANewWorld) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  follower.fly(4.0, 9.0);
  const auto results = follower.fly(1.0, 6.0);
  EXPECT_TRUE(hasEvent(results, "time_jump"));
  const Odometry* first = firstOf(results, 1);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(lastOf(results, 1)->sequence, 1u);
  // At the origin again, known as well as at the very first.
  EXPECT_LT(std::sqrt(first->covariance(0, 0)), 0.1);
  EXPECT_EQ(worldsOf(results, 1), std::set<std::uint32_t>{1});
}

TEST(Estimator, TheRateHasTheNoiseOfTheReadingsInIt) {
  const SyntheticFlight flight = longFlight();
  EstimatorOptions options = optionsFor(flight);
  const double reading = options.imu.gyroscopeVariance(0.005);
  Follower follower(flight, options);
  const auto results = follower.fly(1.0, 6.0);
  ASSERT_NE(lastOf(results, 0), nullptr);
  EXPECT_NEAR(lastOf(results, 0)->angular_velocity_variance, reading, 1e-6 * reading);
  // Halfway between two readings it is their mean.
  options.td = 0.0025;
  Follower between(flight, options);
  const auto averaged = between.fly(1.0, 6.0);
  ASSERT_NE(lastOf(averaged, 0), nullptr);
  EXPECT_NEAR(lastOf(averaged, 0)->angular_velocity_variance, 0.5 * reading, 1e-6 * reading);
}

TEST(Estimator, ReportsTheRigAsConfiguredWhereItIsTrusted) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  const auto results = follower.fly(1.0, 5.0);
  EXPECT_EQ(results.back().rig.T_bc.position, flight.T_bc.position);
  EXPECT_TRUE(results.back().rig_covariance.isZero(0.0));
}

TEST(Estimator, WhileFramesWaitOnlyTheNewestAreAdjusted) {
  const SyntheticFlight flight = longFlight();
  Follower follower(flight, optionsFor(flight));
  follower.fly(1.0, 6.0);
  follower.estimator().setBacklog(5);
  int motion_only = 0, all = 0;
  for (const EstimatorResult& result : follower.fly(6.005, 8.0)) {
    ++all;
    motion_only += result.statistics.motion_only;
  }
  // All but those that make a keyframe.
  EXPECT_GT(motion_only, all / 3);
  follower.estimator().setBacklog(0);
  for (const EstimatorResult& result : follower.fly(8.005, 8.5)) {
    EXPECT_FALSE(result.statistics.motion_only);
  }
}

}  // namespace
}  // namespace vins::estimator
