#include "simulation/feature_simulator.h"

#include <chrono>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "simulation/builtin_trajectories.h"
#include "simulation/euroc_rig.h"
#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

FeatureSimulator makeSimulator(const FeatureSimulatorOptions& options,
                               const std::string& trajectory = "hall_loop") {
  const auto motion = makeBuiltinTrajectory(trajectory, 1, options.start + options.duration);
  return FeatureSimulator(motion, eurocCamera(0), eurocCameraInBody(0), options);
}

FeatureSimulatorOptions shortOptions() {
  FeatureSimulatorOptions options;
  options.duration = 10.0;
  return options;
}

TEST(FeatureSimulator, PixelsAreProjectionsWithTheNoiseAskedFor) {
  FeatureSimulatorOptions options = shortOptions();
  options.pixel_noise = 0.7;
  FeatureSimulator simulator = makeSimulator(options);
  const auto motion = makeBuiltinTrajectory("hall_loop", 1, options.duration);
  const auto camera = eurocCamera(0);
  double sum = 0.0;
  int count = 0;
  while (const auto frame = simulator.next()) {
    const Pose T_wb = motion.poseAt(motion.secondsAt(frame->stamp));
    const Pose T_cw = (T_wb * eurocCameraInBody(0)).inverse();
    for (const FeatureObservation& observation : frame->observations) {
      const auto p_w = simulator.positionOf(observation.id, frame->stamp);
      ASSERT_TRUE(p_w);
      const auto pixel = camera->project(T_cw * *p_w);
      ASSERT_TRUE(pixel);
      sum += (observation.pixel - *pixel).squaredNorm();
      count += 2;
    }
  }
  ASSERT_GT(count, 10000);
  // The deviation of a mean square over so many numbers is below 1 % of it.
  EXPECT_NEAR(std::sqrt(sum / count), 0.7, 0.01);
}

TEST(FeatureSimulator, BearingsVelocitiesAndResolutionsBelongToThePixels) {
  FeatureSimulator simulator = makeSimulator(shortOptions());
  const auto camera = eurocCamera(0);
  std::map<std::int64_t, FeatureObservation> before;
  while (const auto frame = simulator.next()) {
    std::map<std::int64_t, FeatureObservation> now;
    for (const FeatureObservation& observation : frame->observations) {
      now[observation.id] = observation;
      EXPECT_LT((*camera->project(observation.bearing) - observation.pixel).norm(), 1e-6);
      const auto beside = camera->unproject(observation.pixel + Eigen::Vector2d(0.01, 0.0));
      const auto below = camera->unproject(observation.pixel + Eigen::Vector2d(0.0, 0.01));
      const double area =
          (*beside - observation.bearing).cross(*below - observation.bearing).norm() / 1e-4;
      EXPECT_NEAR(observation.angular_resolution, std::sqrt(area), 1e-4 * std::sqrt(area));
      if (!observation.hasVelocity()) continue;
      const FeatureObservation& old = before.at(observation.id);
      EXPECT_EQ(observation.track_length, old.track_length + 1);
      EXPECT_LT((old.bearing + 0.05 * observation.bearing_velocity - observation.bearing).norm(),
                1e-12);
    }
    before = now;
  }
}

TEST(FeatureSimulator, KeepsTheImageFullOfSpreadTracksThatLast) {
  for (const std::string& name : builtinTrajectoryNames()) {
    FeatureSimulatorOptions options = shortOptions();
    FeatureSimulator simulator = makeSimulator(options, name);
    double length = 0.0;
    int frames = 0;
    while (const auto frame = simulator.next()) {
      ++frames;
      EXPECT_GE(frame->observations.size(), 100u) << name;
      EXPECT_LE(frame->observations.size(), 150u) << name;
      for (const auto& observation : frame->observations) {
        length += observation.track_length / 150.0;
        for (const auto& other : frame->observations) {
          // Whoever starts keeps its distance from all that were there.
          if (observation.track_length > 1 || other.id >= observation.id) continue;
          EXPECT_GT((observation.pixel - other.pixel).norm(), options.min_distance - 5.0);
        }
      }
    }
    EXPECT_EQ(frames, 201);
    EXPECT_GT(length / frames, 5.0) << name;
  }
}

TEST(FeatureSimulator, TheSameSeedGivesTheSameFramesAndOutliersLeaveTheNoiseOfOthers) {
  FeatureSimulatorOptions options = shortOptions();
  options.loss_probability = 0.0;
  const auto frames = makeSimulator(options).rest();
  const auto again = makeSimulator(options).rest();
  ASSERT_EQ(frames.size(), again.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(frames[i].observations.size(), again[i].observations.size());
    for (std::size_t j = 0; j < frames[i].observations.size(); ++j) {
      EXPECT_EQ(frames[i].observations[j].pixel, again[i].observations[j].pixel);
    }
  }
  options.outlier_ratio = 0.1;
  const auto first = makeSimulator(options).next();
  int moved = 0;
  std::map<std::int64_t, Eigen::Vector2d> pixels;
  for (const auto& observation : frames[0].observations) pixels[observation.id] = observation.pixel;
  for (const auto& observation : first->observations) {
    moved += observation.pixel != pixels[observation.id] ? 1 : 0;
  }
  EXPECT_GT(moved, 0);
  options.seed = 2;
  EXPECT_NE(makeSimulator(options).next()->observations[0].pixel, first->observations[0].pixel);
}

TEST(FeatureSimulator, LandmarksSwingWhereAskedTo) {
  FeatureSimulatorOptions options = shortOptions();
  options.moving_fraction = 0.3;
  FeatureSimulator simulator = makeSimulator(options);
  const auto frame = simulator.next();
  int moving = 0;
  for (const auto& observation : frame->observations) {
    const auto now = simulator.positionOf(observation.id, frame->stamp);
    const auto later = simulator.positionOf(observation.id, frame->stamp + 1'000'000'000);
    moving += *now != *later ? 1 : 0;
  }
  const double share = moving / static_cast<double>(frame->observations.size());
  EXPECT_NEAR(share, 0.3, 0.15);
  EXPECT_FALSE(simulator.positionOf(-1, 0));
  EXPECT_FALSE(simulator.positionOf(1000000, 0));
}

TEST(FeatureSimulator, ARollingShutterSeesEachRowAtItsTime) {
  FeatureSimulatorOptions options = shortOptions();
  options.duration = 3.0;
  options.pixel_noise = 0.0;
  options.readout = 0.02;
  FeatureSimulator simulator = makeSimulator(options);
  const auto motion = makeBuiltinTrajectory("hall_loop", 1, options.duration);
  const auto camera = eurocCamera(0);
  double furthest = 0.0, largest_shift = 0.0;
  for (int frame = 0; frame < 50; ++frame) {
    const auto seen = simulator.next();
    ASSERT_TRUE(seen);
    const double t = motion.secondsAt(seen->stamp);
    for (const FeatureObservation& observation : seen->observations) {
      const auto pixelAt = [&](double t_row) {
        const Pose T_cw = (motion.poseAt(t_row) * eurocCameraInBody(0)).inverse();
        return *camera->project(T_cw * *simulator.positionOf(observation.id, seen->stamp));
      };
      const Eigen::Vector2d in_row = pixelAt(t + options.readout * observation.pixel.y() / 480.0);
      furthest = std::max(furthest, (observation.pixel - in_row).norm());
      largest_shift = std::max(largest_shift, (observation.pixel - pixelAt(t)).norm());
    }
  }
  EXPECT_LT(furthest, 0.01);
  EXPECT_GT(largest_shift, 2.0) << "the flight does not show it";
}

TEST(FeatureSimulator, AMinuteTakesAboutASecond) {
  const auto start = std::chrono::steady_clock::now();
  FeatureSimulatorOptions options;
  const auto frames = makeSimulator(options).rest();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(frames.size(), 1201u);
  // Room for other programs on the machine.
  EXPECT_LT(elapsed.count(), 4.0);
  RecordProperty("milliseconds", static_cast<int>(1e3 * elapsed.count()));
}

TEST(FeatureSimulator, RefusesBadOptionsAndTimesBeyondTheMotion) {
  FeatureSimulatorOptions options;
  options.pixel_noise = -1.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.image_rate = 0.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.outlier_ratio = std::nan("");
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  const auto motion = makeBuiltinTrajectory("still", 1, 10.0);
  EXPECT_THROW(FeatureSimulator(motion, eurocCamera(0), eurocCameraInBody(0), options), InputError);
}

}  // namespace
}  // namespace vins::simulation
