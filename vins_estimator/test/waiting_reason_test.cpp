#include "vins_estimator/initialization/waiting_reason.h"

#include <memory>

#include <gtest/gtest.h>

namespace vins::estimator {
namespace {

/// Of a rig that moves as it should: each test changes what is the matter.
InputFigures good() { return {150, 0.95, 0.3, 0.005, 0.05}; }

bool contains(const WaitingReason& reason, const std::string& part) {
  return reason.text.find(part) != std::string::npos;
}

VisualStructure failed(StructureStatus status) {
  VisualStructure structure;
  structure.status = status;
  return structure;
}

TEST(WaitingReason, FewFeaturesAskForLightAndTexture) {
  InputFigures inputs = good();
  inputs.features = 12;
  EXPECT_TRUE(contains(explainFewTracks(inputs), "too few features in the images, 12"));
  EXPECT_TRUE(contains(explainFewTracks(inputs), "textured scene"));
}

TEST(WaitingReason, ManyFeaturesThatDoNotLastAreNoLackOfTexture) {
  InputFigures inputs = good();
  inputs.lasting = 0.2;
  inputs.turn_rate = 17.0;
  const WaitingReason fast = explainFewTracks(inputs);
  EXPECT_FALSE(contains(fast, "textured scene"));
  EXPECT_TRUE(contains(fast, "only 20 % of them")) << fast.text;
  EXPECT_TRUE(contains(fast, "the gyroscope turns at 17 rad/s")) << fast.text;
  EXPECT_TRUE(contains(fast, "not in rad/s"));
  EXPECT_STREQ(fast.code, "init_few_tracks");
  inputs.turn_rate = 0.2;
  EXPECT_TRUE(contains(explainFewTracks(inputs), "blurred"));
  inputs.image_period = 0.25;
  EXPECT_TRUE(contains(explainFewTracks(inputs), "images come only every 0.25 s"));
}

TEST(WaitingReason, FeaturesThatLeaveTheViewAreNamedWithTheTurn) {
  InputFigures inputs = good();
  EXPECT_TRUE(contains(explainFewTracks(inputs), "move more slowly"));
  inputs.turn_rate = 1.2;
  EXPECT_TRUE(contains(explainFewTracks(inputs), "less turning"));
  EXPECT_TRUE(contains(explain(failed(StructureStatus::kLostFrame), inputs), "less turning"));
}

TEST(WaitingReason, ImagesAndGyroscopeThatContradictPointToTheGyroscopeWhereItIsOdd) {
  const VisualStructure structure = failed(StructureStatus::kNoRelativePose);
  InputFigures inputs = good();
  EXPECT_TRUE(contains(explain(structure, inputs), "check T_bc, td and the intrinsics"));
  inputs.turn_rate = 15.0;
  EXPECT_TRUE(contains(explain(structure, inputs), "15 rad/s on average: is it in deg/s?"));
  inputs.turn_rate = 0.0;
  EXPECT_TRUE(contains(explain(structure, inputs), "no turn at all"));
  inputs = good();
  inputs.imu_period = 0.05;
  EXPECT_TRUE(contains(explain(structure, inputs), "only every 0.05 s"));
  EXPECT_STREQ(explain(structure, inputs).code, "init_inconsistent");
}

TEST(WaitingReason, LittleParallaxIsToldWhateverTheInputs) {
  InputFigures inputs = good();
  inputs.turn_rate = 5.0;
  const WaitingReason reason = explain(failed(StructureStatus::kLittleParallax), inputs);
  EXPECT_STREQ(reason.code, "init_little_parallax");
  EXPECT_TRUE(contains(reason, "move sideways"));
}

TEST(WaitingReason, AnAlignmentThatFailsNamesASlowImu) {
  Alignment alignment;
  alignment.status = AlignmentStatus::kGravityImplausible;
  InputFigures inputs = good();
  EXPECT_FALSE(contains(explain(alignment, inputs), "raise the IMU's rate"));
  inputs.imu_period = 0.04;
  EXPECT_TRUE(contains(explain(alignment, inputs), "raise the IMU's rate"));
  alignment.status = AlignmentStatus::kLittleExcitation;
  EXPECT_FALSE(contains(explain(alignment, inputs), "raise the IMU's rate"));
}

TEST(WaitingReason, GravityThatIsNoneTellsItsUnitOrThatItIsMissing) {
  Alignment alignment;
  alignment.status = AlignmentStatus::kGravityImplausible;
  alignment.gravity = 1.01;
  EXPECT_TRUE(contains(explain(alignment, good()), "is it in g?"));
  alignment.gravity = 0.08;
  EXPECT_TRUE(contains(explain(alignment, good()), "not fill linear_acceleration"));
  alignment.gravity = 12.0;
  EXPECT_TRUE(contains(explain(alignment, good()), "12 m/s^2 and no gravity; check g_norm"));
}

TEST(WaitingReason, AnOddGyroscopeIsNamedWhicheverPartFails) {
  InputFigures inputs = good();
  inputs.turn_rate = 33.0;
  EXPECT_TRUE(contains(explainFewTracks(inputs), "is it in deg/s?"));
  inputs.turn_rate = 0.0;
  EXPECT_TRUE(contains(explainFewTracks(inputs), "does the driver fill angular_velocity?"));
  Alignment alignment;
  alignment.status = AlignmentStatus::kGyroscopeDisagrees;
  EXPECT_TRUE(contains(explain(alignment, inputs), "does the driver fill angular_velocity?"));
  EXPECT_TRUE(contains(explain(alignment, good()), "check T_bc, td and the intrinsics"));
}

/// Frames at 20 Hz with 100 features, of which the next frame has `lasting`.
std::deque<SharedMeasurements> framesWith(int lasting) {
  std::deque<SharedMeasurements> frames;
  for (int i = 0; i < 5; ++i) {
    FrameMeasurements frame;
    frame.frame.stamp = i * Stamp{50'000'000};
    for (int k = 0; k < 100; ++k) {
      FeatureObservation observation;
      observation.id = i * (100 - lasting) + k;
      frame.frame.observations.push_back(observation);
    }
    for (int k = 0; k <= 10; ++k) {
      frame.imu.push_back(
          {frame.frame.stamp + k * Stamp{5'000'000}, Eigen::Vector3d::Zero(), {0.0, 0.6, 0.8}});
    }
    frame.longest_gap = i == 2 ? 0.1 : 0.005;
    frames.push_back(std::make_shared<FrameMeasurements>(frame));
  }
  return frames;
}

TEST(WaitingReason, FiguresAreThoseOfTheFrames) {
  const InputFigures figures = figuresOf(framesWith(70));
  EXPECT_EQ(figures.features, 100);
  EXPECT_NEAR(figures.lasting, 0.7, 1e-12);
  EXPECT_NEAR(figures.turn_rate, 1.0, 1e-12);
  EXPECT_EQ(figures.imu_period, 0.005) << "one gap is not the period";
  EXPECT_NEAR(figures.image_period, 0.05, 1e-12);
}

}  // namespace
}  // namespace vins::estimator
