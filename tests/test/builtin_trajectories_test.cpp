#include "simulation/builtin_trajectories.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/scene_catalogue.h"
#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

/// Largest values within a time.
struct Extremes {
  double speed = 0.0, acceleration = 0.0, turn_rate = 0.0, elevation = 0.0, camera_speed = 0.0;
};

Extremes extremesOf(const TrajectorySpline& spline, double from, double to) {
  const Pose T_bc = eurocCameraInBody(0);
  Extremes most;
  for (double t = from; t <= to; t += 0.01) {
    const MotionState state = spline.at(t);
    const Vector3d ahead_w = state.T_wb.rotation * (T_bc.rotation * Vector3d::UnitZ());
    const Vector3d camera_velocity =
        state.velocity_w + state.T_wb.rotation * state.angular_velocity_b.cross(T_bc.position);
    most.speed = std::max(most.speed, state.velocity_w.norm());
    most.acceleration = std::max(most.acceleration, state.acceleration_w.norm());
    most.turn_rate = std::max(most.turn_rate, state.angular_velocity_b.norm());
    most.elevation = std::max(most.elevation, std::abs(std::asin(ahead_w.z())));
    most.camera_speed = std::max(most.camera_speed, camera_velocity.norm());
  }
  return most;
}

class Builtin : public ::testing::TestWithParam<std::string> {};

TEST_P(Builtin, StartsAndEndsExactlyAtRest) {
  const TrajectorySpline spline = makeBuiltinTrajectory(GetParam(), 2, 30.0);
  for (const double t : {-0.9, 0.0, 30.0, 30.9}) {
    const MotionState state = spline.at(t);
    EXPECT_EQ(state.velocity_w, Vector3d::Zero()) << t;
    EXPECT_EQ(state.acceleration_w, Vector3d::Zero()) << t;
    EXPECT_EQ(state.angular_velocity_b, Vector3d::Zero()) << t;
    EXPECT_EQ(state.angular_acceleration_b, Vector3d::Zero()) << t;
  }
}

TEST_P(Builtin, MovesAsAMultirotorCan) {
  for (const double duration : {20.0, 60.0, 150.0}) {
    const Extremes most = extremesOf(makeBuiltinTrajectory(GetParam(), 1, duration), 0.0, duration);
    const bool fast = GetParam() == "fast";
    EXPECT_LT(most.speed, fast ? 3.0 : 1.9) << duration;
    EXPECT_LT(most.acceleration, fast ? 8.0 : 3.5) << duration;
    EXPECT_LT(most.turn_rate, fast ? 3.5 : 2.5) << duration;
    // Who films a room looks down.
    const bool looks_down = GetParam() == "walk";
    EXPECT_LT(most.elevation, fast ? 0.8 : looks_down ? 0.65 : 0.5) << duration;
  }
}

TEST_P(Builtin, SeedsRepeatAndDiffer) {
  const auto positionOf = [](std::uint64_t seed) -> Vector3d {
    return makeBuiltinTrajectory(GetParam(), seed, 25.0).poseAt(12.5).position;
  };
  EXPECT_EQ(positionOf(4), positionOf(4));
  EXPECT_EQ(positionOf(4) == positionOf(5), GetParam() == "still");
}

INSTANTIATE_TEST_SUITE_P(All, Builtin, ::testing::ValuesIn(builtinTrajectoryNames()),
                         [](const auto& info) { return info.param; });

TEST(BuiltinTrajectory, StaysInTheFreeSpaceOfItsScene) {
  for (const std::string place : {"room", "hall", "corridor", "household"}) {
    const Scene scene = makeScene(place, 1);
    for (const std::string& name : builtinTrajectoryNames()) {
      if (sceneOfBuiltinTrajectory(name) != place) continue;
      const TrajectorySpline spline = makeBuiltinTrajectory(name, 3, 60.0);
      for (double t = 0.0; t <= 60.0; t += 0.2) {
        EXPECT_TRUE(scene.isFree(spline.poseAt(t).position, 0.25))
            << name << " at " << t << " s: " << spline.poseAt(t).position.transpose();
      }
    }
  }
}

TEST(BuiltinTrajectory, LoopsComeBackToTheirStart) {
  for (const std::string name : {"hall_loop", "figure_eight", "corridor", "fast"}) {
    const TrajectorySpline spline = makeBuiltinTrajectory(name, 1, 60.0);
    const Pose start = spline.poseAt(0.0), end = spline.poseAt(60.0);
    EXPECT_LT((end.position - start.position).norm(), 1e-9) << name;
    EXPECT_LT(end.rotation.angularDistance(start.rotation), 1e-6) << name;
  }
}

TEST(BuiltinTrajectory, FastIsAboutAsFastAsV103) {
  const Extremes most = extremesOf(makeBuiltinTrajectory("fast", 1, 60.0), 0.0, 60.0);
  EXPECT_GT(most.speed, 2.0);
  EXPECT_GT(most.turn_rate, 2.0);
  EXPECT_GT(most.acceleration, 4.0);
}

TEST(BuiltinTrajectory, PureRotationKeepsTheCameraInPlaceForFifteenSeconds) {
  const TrajectorySpline spline = makeBuiltinTrajectory("pure_rotation", 1, 40.0);
  const Pose T_bc = eurocCameraInBody(0);
  const Vector3d start = spline.poseAt(0.0) * T_bc.position;
  for (double t = 0.0; t < 15.0; t += 0.05) {
    // A tenth of a millimetre is a twentieth of a pixel at the nearest furniture.
    EXPECT_LT((spline.poseAt(t) * T_bc.position - start).norm(), 1e-4) << t;
  }
  EXPECT_GT(extremesOf(spline, 0.0, 15.0).turn_rate, 0.5);
  EXPECT_GT(extremesOf(spline, 15.0, 40.0).speed, 0.5);
}

TEST(BuiltinTrajectory, StaticThenMoveRestsForFourSeconds) {
  const TrajectorySpline spline = makeBuiltinTrajectory("static_then_move", 1, 30.0);
  EXPECT_EQ(extremesOf(spline, 0.0, 3.99).speed, 0.0);
  EXPECT_EQ(extremesOf(spline, 0.0, 3.99).turn_rate, 0.0);
  EXPECT_GT(extremesOf(spline, 4.0, 7.0).speed, 0.3);
}

TEST(BuiltinTrajectory, HoverStaysWithinCentimetres) {
  const TrajectorySpline spline = makeBuiltinTrajectory("hover", 1, 60.0);
  const Vector3d start = spline.poseAt(0.0).position;
  double most = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.05) {
    most = std::max(most, (spline.poseAt(t).position - start).norm());
  }
  EXPECT_GT(most, 0.01);
  EXPECT_LT(most, 0.12);
}

TEST(BuiltinTrajectory, ErrorsNameWhatIsAllowed) {
  try {
    makeBuiltinTrajectory("loop", 1, 10.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("found 'loop'; allowed: hall_loop"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(makeBuiltinTrajectory("still", 1, 0.0), InputError);
  EXPECT_THROW(makeBuiltinTrajectory("still", 1, NAN), InputError);
}

}  // namespace
}  // namespace vins::simulation
