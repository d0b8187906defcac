#include "simulation/imu_simulator.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/builtin_trajectories.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

constexpr Stamp kSecond = 1000000000;

ImuOptions noiseFree(double rate) {
  ImuOptions options;
  options.rate = rate;
  options.noise_free = true;
  return options;
}

/// Integrates samples by the midpoint rule from the state at the first one; returns the distance
/// from the true position at the last one [m].
double integrationError(const TrajectorySpline& trajectory, const std::vector<ImuSample>& samples) {
  const MotionState start = trajectory.at(trajectory.secondsAt(samples.front().stamp));
  const Vector3d g_w(0.0, 0.0, -9.81);
  Vector3d p = start.T_wb.position, v = start.velocity_w;
  Eigen::Quaterniond R = start.T_wb.rotation;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = toSeconds(samples[i].stamp - samples[i - 1].stamp);
    const Vector3d omega = 0.5 * (samples[i - 1].angular_velocity + samples[i].angular_velocity);
    const Eigen::Quaterniond R_next = R * so3::exp(dt * omega);
    const Vector3d a =
        0.5 * (R * samples[i - 1].acceleration + R_next * samples[i].acceleration) + g_w;
    p += dt * v + 0.5 * dt * dt * a;
    v += dt * a;
    R = R_next;
  }
  const Pose end = trajectory.poseAt(trajectory.secondsAt(samples.back().stamp));
  return (p - end.position).norm();
}

/// White noise of one channel in units of its expected deviation.
std::vector<double> whiteNoise(const TrajectorySpline& still, const ImuOptions& options,
                               std::uint64_t seed) {
  const ImuRecording recording = simulateImu(still, 0, 100 * kSecond, options, seed);
  const Vector3d f_b = still.poseAt(0.0).rotation.conjugate() * Vector3d(0.0, 0.0, 9.81);
  const double deviation = options.noise.accelerometer_noise * std::sqrt(options.rate);
  std::vector<double> noise;
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const Vector3d error =
        recording.samples[i].acceleration - f_b - recording.biases[i].accelerometer;
    noise.push_back(error.x() / deviation);
  }
  return noise;
}

double meanProduct(const std::vector<double>& a, const std::vector<double>& b, std::size_t shift) {
  double sum = 0.0;
  for (std::size_t i = 0; i + shift < a.size(); ++i) sum += a[i] * b[i + shift];
  return sum / static_cast<double>(a.size() - shift);
}

TEST(ImuSimulator, IntegratedSamplesReproduceTheTrajectory) {
  for (const std::string name : {"hall_loop", "fast", "corridor"}) {
    const TrajectorySpline trajectory = makeBuiltinTrajectory(name, 1, 20.0);
    const auto samples =
        simulateImu(trajectory, 3 * kSecond, 13 * kSecond, noiseFree(2000.0), 1).samples;
    EXPECT_LT(integrationError(trajectory, samples), 1e-3) << name;
  }
}

TEST(ImuSimulator, IntegrationErrorFallsWithTheSquareOfTheRate) {
  const TrajectorySpline trajectory = makeBuiltinTrajectory("fast", 1, 20.0);
  std::vector<double> errors;
  for (const double rate : {50.0, 100.0, 200.0, 400.0}) {
    const auto samples =
        simulateImu(trajectory, 3 * kSecond, 13 * kSecond, noiseFree(rate), 1).samples;
    errors.push_back(integrationError(trajectory, samples));
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double order = std::log2(errors[i - 1] / errors[i]);
    EXPECT_NEAR(order, 2.0, 0.15) << "between errors " << errors[i - 1] << " and " << errors[i];
  }
}

TEST(ImuSimulator, AtRestMeasuresGravityUpwards) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 10.0);
  const auto samples = simulateImu(still, 0, 10 * kSecond, noiseFree(200.0), 1).samples;
  ASSERT_EQ(samples.size(), 2001u);
  const Eigen::Quaterniond R_wb = still.poseAt(0.0).rotation;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].stamp, static_cast<Stamp>(i) * 5000000);
    EXPECT_LT((R_wb * samples[i].acceleration - Vector3d(0.0, 0.0, 9.81)).norm(), 1e-12);
    EXPECT_EQ(samples[i].angular_velocity, Vector3d::Zero());
  }
}

TEST(ImuSimulator, ATimeOffsetStampsTheSamplesLater) {
  const TrajectorySpline trajectory = makeBuiltinTrajectory("fast", 1, 10.0);
  ImuOptions late = noiseFree(200.0);
  late.time_offset = 0.015;  // three samples
  const auto exact = simulateImu(trajectory, kSecond, 5 * kSecond, noiseFree(200.0), 1).samples;
  const auto shifted = simulateImu(trajectory, kSecond, 5 * kSecond, late, 1).samples;
  for (std::size_t i = 3; i < exact.size(); ++i) {
    EXPECT_LT((shifted[i].acceleration - exact[i - 3].acceleration).norm(), 1e-9);
    EXPECT_LT((shifted[i].angular_velocity - exact[i - 3].angular_velocity).norm(), 1e-9);
  }
}

TEST(ImuSimulator, WhiteNoiseHasItsDensityAndNoMemory) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 100.0);
  for (const double rate : {100.0, 400.0}) {
    ImuOptions options;
    options.rate = rate;
    const std::vector<double> noise = whiteNoise(still, options, 1);
    const auto count = static_cast<double>(noise.size());
    // Five deviations of a sample variance, and of a sample correlation.
    EXPECT_NEAR(meanProduct(noise, noise, 0), 1.0, 5.0 * std::sqrt(2.0 / count)) << rate;
    for (std::size_t shift = 1; shift < 30; ++shift) {
      EXPECT_NEAR(meanProduct(noise, noise, shift), 0.0, 5.0 / std::sqrt(count)) << shift;
    }
  }
}

TEST(ImuSimulator, GyroscopeNoiseHasItsDensity) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 100.0);
  const ImuOptions options;
  const ImuRecording recording = simulateImu(still, 0, 100 * kSecond, options, 1);
  double squares = 0.0;
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    squares +=
        (recording.samples[i].angular_velocity - recording.biases[i].gyroscope).squaredNorm();
  }
  const double count = 3.0 * static_cast<double>(recording.samples.size());
  const double variance = std::pow(options.noise.gyroscope_noise, 2) * options.rate;
  EXPECT_NEAR(squares / count / variance, 1.0, 5.0 * std::sqrt(2.0 / count));
}

TEST(ImuSimulator, BiasVarianceGrowsWithTime) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 100.0);
  ImuOptions options;
  options.rate = 50.0;
  options.initial_gyroscope_bias = {0.1, 0.2, 0.3};
  for (const Stamp duration : {5 * kSecond, 20 * kSecond}) {
    double accelerometer = 0.0, gyroscope = 0.0;
    const int runs = 400;
    for (int seed = 0; seed < runs; ++seed) {
      const auto bias =
          simulateImu(still, 0, duration, options, static_cast<std::uint64_t>(seed)).biases.back();
      accelerometer += bias.accelerometer.squaredNorm();
      gyroscope += (bias.gyroscope - options.initial_gyroscope_bias).squaredNorm();
    }
    const double count = 3.0 * runs, t = toSeconds(duration);
    const double bound = 5.0 * std::sqrt(2.0 / count);
    const double expected_accelerometer = std::pow(options.noise.accelerometer_walk, 2) * t;
    const double expected_gyroscope = std::pow(options.noise.gyroscope_walk, 2) * t;
    EXPECT_NEAR(accelerometer / count / expected_accelerometer, 1.0, bound) << t;
    EXPECT_NEAR(gyroscope / count / expected_gyroscope, 1.0, bound) << t;
  }
}

TEST(ImuSimulator, SameSeedSameSamplesNeighbouringSeedsShareNothing) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 100.0);
  const ImuOptions options;
  const std::vector<double> a = whiteNoise(still, options, 7), b = whiteNoise(still, options, 8);
  EXPECT_EQ(a, whiteNoise(still, options, 7));
  const double bound = 5.0 / std::sqrt(static_cast<double>(a.size()));
  for (std::size_t shift = 0; shift < 60; ++shift) {
    EXPECT_LT(std::abs(meanProduct(a, b, shift)), bound) << shift;
    EXPECT_LT(std::abs(meanProduct(b, a, shift)), bound) << shift;
  }
}

TEST(ImuSimulator, VibrationAddsItsPowerAndLeavesTheNoiseAsItIs) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 60.0);
  ImuOptions options;
  const ImuRecording quiet = simulateImu(still, 0, 60 * kSecond, options, 3);
  options.vibrations = {{90.0, 4.0, 0.8, 0.03}};
  const ImuRecording shaken = simulateImu(still, 0, 60 * kSecond, options, 3);
  double acceleration = 0.0, turning = 0.0;
  for (std::size_t i = 0; i < quiet.samples.size(); ++i) {
    EXPECT_EQ(quiet.biases[i].accelerometer, shaken.biases[i].accelerometer);
    acceleration += (shaken.samples[i].acceleration - quiet.samples[i].acceleration).squaredNorm();
    turning +=
        (shaken.samples[i].angular_velocity - quiet.samples[i].angular_velocity).squaredNorm();
  }
  // What is left is the vibration alone, since both have the same noise.
  const double count = 3.0 * static_cast<double>(quiet.samples.size());
  EXPECT_NEAR(std::sqrt(acceleration / count), 0.8, 0.05);
  EXPECT_NEAR(std::sqrt(turning / count), 0.03, 0.002);
}

TEST(ImuSimulator, RefusesBadOptionsAndTimesBeyondTheTrajectory) {
  const TrajectorySpline still = makeBuiltinTrajectory("still", 1, 10.0);
  EXPECT_THROW(simulateImu(still, 0, 20 * kSecond, noiseFree(200.0), 1), InputError);
  ImuOptions options;
  options.rate = 0.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.noise.accelerometer_noise = -1.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.vibrations = {{90.0, 4.0, -1.0, 0.0}};
  EXPECT_THROW(options.validate(), InputError);
}

TEST(ImuSimulator, ErrorsOfScaleAndAlignmentMultiplyTheTruth) {
  const TrajectorySpline fast = makeBuiltinTrajectory("fast", 1, 10.0);
  ImuOptions options = noiseFree(100.0);
  const ImuRecording truth = simulateImu(fast, 0, 5 * kSecond, options, 1);
  options.accelerometer_gain.diagonal() = Vector3d(1.01, 0.99, 1.0);
  options.gyroscope_gain.diagonal() = Vector3d(0.98, 1.0, 1.01);
  options.gyroscope_gain(0, 1) = 0.003;
  const ImuRecording erring = simulateImu(fast, 0, 5 * kSecond, options, 1);
  for (std::size_t i = 0; i < truth.samples.size(); ++i) {
    const Vector3d f = truth.samples[i].acceleration, w = truth.samples[i].angular_velocity;
    EXPECT_LT((erring.samples[i].acceleration - Vector3d(1.01 * f.x(), 0.99 * f.y(), f.z())).norm(),
              1e-12);
    const Vector3d expected(0.98 * w.x() + 0.003 * w.y(), w.y(), 1.01 * w.z());
    EXPECT_LT((erring.samples[i].angular_velocity - expected).norm(), 1e-12);
  }
}

TEST(ImuSimulator, AnAccelerometerOfItsOwnRateIsJoinedByInterpolation) {
  const TrajectorySpline fast = makeBuiltinTrajectory("fast", 1, 10.0);
  ImuOptions options = noiseFree(200.0);
  const ImuRecording one = simulateImu(fast, 0, 5 * kSecond, options, 1);
  options.accelerometer_rate = 62.5;
  const ImuRecording joined = simulateImu(fast, 0, 5 * kSecond, options, 1);
  ASSERT_EQ(joined.samples.size(), one.samples.size());
  double most = 0.0, bends = 0.0;
  for (std::size_t i = 0; i < one.samples.size(); ++i) {
    EXPECT_EQ(joined.samples[i].angular_velocity, one.samples[i].angular_velocity);
    most = std::max(most, (joined.samples[i].acceleration - one.samples[i].acceleration).norm());
    if (i < 2) continue;
    const Vector3d bend = joined.samples[i].acceleration -
                          2.0 * joined.samples[i - 1].acceleration +
                          joined.samples[i - 2].acceleration;
    bends += bend.norm() > 1e-5 ? 1.0 : 0.0;
  }
  // Wrong, for it is interpolated over 16 ms, but not by much.
  EXPECT_GT(most, 1e-4);
  EXPECT_LT(most, 0.3);
  // Straight between its own samples: a second difference at 200 Hz bends once for each of them, in
  // two places at most.
  EXPECT_LT(bends, 2.0 * 5.0 * 62.5 + 4.0);
}

TEST(ImuSimulator, JitteredStampsRiseAndTellTheTruthAtTheirTime) {
  const TrajectorySpline fast = makeBuiltinTrajectory("fast", 1, 10.0);
  ImuOptions options = noiseFree(200.0);
  options.stamp_jitter_s = 0.002;
  const ImuRecording imu = simulateImu(fast, 0, 5 * kSecond, options, 1);
  double least = 1.0, most = 0.0;
  for (std::size_t i = 1; i < imu.samples.size(); ++i) {
    const double interval = toSeconds(imu.samples[i].stamp - imu.samples[i - 1].stamp);
    least = std::min(least, interval);
    most = std::max(most, interval);
    const MotionState state = fast.at(fast.secondsAt(imu.samples[i].stamp));
    EXPECT_LT((imu.samples[i].angular_velocity - state.angular_velocity_b).norm(), 1e-12);
  }
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.002);
  EXPECT_GT(most, 0.008);
}

}  // namespace
}  // namespace vins::simulation
