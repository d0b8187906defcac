#include "simulation/walking_motion.h"

#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/builtin_trajectories.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kDuration = 60.0;
constexpr double kStep = 0.01;  ///< [s]

TrajectorySpline walk(std::uint64_t seed) { return makeBuiltinTrajectory("walk", seed, kDuration); }

/// A component of the acceleration, every kStep.
std::vector<double> accelerations(const TrajectorySpline& spline, int axis) {
  std::vector<double> values;
  for (double t = 2.0; t < kDuration - 2.0; t += kStep) {
    values.push_back(spline.at(t).acceleration_w[axis]);
  }
  return values;
}

/// Root mean square of what lies between two frequencies [Hz].
double bandPower(const std::vector<double>& values, double low, double high) {
  const auto count = static_cast<double>(values.size());
  double power = 0.0;
  const double resolution = 1.0 / (count * kStep);
  for (double f = std::ceil(low / resolution) * resolution; f < high; f += resolution) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum += values[i] * std::polar(1.0, -2.0 * M_PI * f * kStep * static_cast<double>(i));
    }
    power += 2.0 * std::norm(sum) / (count * count);
  }
  return std::sqrt(power);
}

TEST(WalkingMotion, BobsAtTheStepFrequency) {
  const std::vector<double> up = accelerations(walk(1), 2);
  const double at_steps = bandPower(up, 1.6, 2.0);
  EXPECT_GT(at_steps, 0.2);
  // A pendulum's bob of steps of 0.3 m is some centimetre: no runner's.
  EXPECT_LT(at_steps, 1.0);
  EXPECT_GT(at_steps, 3.0 * bandPower(up, 0.8, 1.2));
  EXPECT_GT(at_steps, 3.0 * bandPower(up, 2.4, 2.8));
}

/// Second differences of an axis of the difference of two walks [m/s^2].
std::vector<double> accelerationsBetween(const GaitOptions& one, const GaitOptions& other,
                                         int axis) {
  const Walk a(one, 0.3, kDuration, 1), b(other, 0.3, kDuration, 1);
  const auto at = [&](double t) { return a.at(t).position_w[axis] - b.at(t).position_w[axis]; };
  std::vector<double> values;
  for (double t = 3.0; t < kDuration - 3.0; t += kStep) {
    values.push_back((at(t - kStep) - 2.0 * at(t) + at(t + kStep)) / (kStep * kStep));
  }
  return values;
}

TEST(WalkingMotion, SwaysAtHalfTheStepFrequency) {
  // In a large room: short legs would widen the line.
  GaitOptions swaying;
  swaying.half_side = 12.0;
  GaitOptions straight = swaying;
  straight.lateral_sway = 0.0;
  const std::vector<double> aside = accelerationsBetween(swaying, straight, 0);
  EXPECT_GT(bandPower(aside, 0.8, 1.0), 0.1);
  EXPECT_GT(bandPower(aside, 0.8, 1.0), 3.0 * bandPower(aside, 1.2, 1.4));
  EXPECT_GT(bandPower(aside, 0.8, 1.0), 3.0 * bandPower(aside, 0.4, 0.6));
}

TEST(WalkingMotion, TremblesAsAHandDoes) {
  // A recorded walk's IMU has 0.13 m/s^2 of 4 to 8 Hz and as much of 8 to 15 Hz in the norm of the
  // specific force; the default shares its 0.12 m/s^2 per axis out to both.
  GaitOptions firm;
  firm.tremor_acceleration = 0.0;
  const std::vector<double> up = accelerationsBetween(GaitOptions{}, firm, 2);
  EXPECT_NEAR(bandPower(up, 4.0, 8.0), 0.12 * std::sqrt(0.5), 0.03);
  EXPECT_NEAR(bandPower(up, 8.0, 13.0), 0.12 * std::sqrt(0.5), 0.03);
}

TEST(WalkingMotion, GoesTwentyMetresAMinuteAndPauses) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Walk walk(GaitOptions{}, 0.3, kDuration - 0.3, seed);
    double path = 0.0, paused = 0.0;
    for (double t = 0.0; t < kDuration; t += kStep) {
      const Vector3d step = walk.at(t + kStep).position_w - walk.at(t).position_w;
      path += step.head<2>().norm();
      paused += walk.activity(t) == 0.0 ? kStep : 0.0;
    }
    EXPECT_NEAR(path, 20.0, 6.0) << seed;
    EXPECT_GT(paused, 0.2 * kDuration) << seed;
    EXPECT_LT(paused, 0.7 * kDuration) << seed;
  }
}

TEST(WalkingMotion, TurnsOnTheSpot) {
  const Walk walk(GaitOptions{}, 0.3, kDuration - 0.3, 1);
  double most = 0.0;
  for (double t = 3.0; t < kDuration - 3.0; t += kStep) {
    const double rate = std::abs(walk.at(t + kStep).yaw - walk.at(t).yaw) / kStep;
    if (walk.activity(t) == 0.0) most = std::max(most, rate);
  }
  EXPECT_GT(most, 0.7);
  EXPECT_LT(most, 1.6);
}

TEST(WalkingMotion, StaysInTheMiddleOfTheRoomWithoutJumps) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Walk walk(GaitOptions{}, 0.3, kDuration - 0.3, seed);
    for (double t = 0.0; t < kDuration; t += kStep) {
      const DesignedPose now = walk.at(t), next = walk.at(t + kStep);
      EXPECT_LT(now.position_w.head<2>().cwiseAbs().maxCoeff(), 0.95) << seed << " at " << t;
      EXPECT_LT((next.position_w - now.position_w).norm(), 1.2 * kStep) << seed << " at " << t;
      EXPECT_LT(std::abs(next.yaw - now.yaw), 2.0 * kStep) << seed << " at " << t;
    }
  }
}

}  // namespace
}  // namespace vins::simulation
