#include "vins_estimator/initialization/static_initializer.h"

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

std::vector<const FrameMeasurements*> pointersTo(const std::vector<FrameMeasurements>& recording) {
  std::vector<const FrameMeasurements*> pointers;
  for (const auto& measurements : recording) pointers.push_back(&measurements);
  return pointers;
}

std::vector<FrameMeasurements> rest(const Eigen::Quaterniond& R_wb,
                                    const Vector3d& gyroscope_bias) {
  testing::SyntheticFlight flight = testing::livelyFlight();
  flight.motion = [R_wb](double) { return Pose(R_wb, {1.0, 2.0, 3.0}); };
  flight.gyroscope_bias = gyroscope_bias;
  return flight.record(0.0, 0.5);
}

TEST(StaticInitializer, FindsTiltAndGyroscopeBias) {
  const Vector3d bias(0.03, -0.02, 0.08);
  for (const Vector3d& turn :
       {Vector3d(0, 0, 0), Vector3d(0.3, -0.5, 1.0), Vector3d(0, -1.57, 0), Vector3d(2, 1, 0)}) {
    const auto recording = rest(so3::exp(turn), bias);
    const auto found = initializeAtRest(pointersTo(recording), ImuNoise());
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->at_rest);
    ASSERT_EQ(found->frames.size(), 4u);
    const NavState& state = found->frames.front().state;
    const Vector3d up = state.T_wb.rotation.conjugate() * Vector3d::UnitZ();
    EXPECT_LT((up - so3::exp(turn).conjugate() * Vector3d::UnitZ()).norm(), 1e-6);
    EXPECT_LT((state.gyroscope_bias - bias).norm(), 1e-9);
    EXPECT_TRUE(state.v_w.isZero(0.0) && state.T_wb.position.isZero(0.0));
    EXPECT_TRUE(found->sigma.allFinite() && (found->sigma.array() > 0.0).all());
  }
}

TEST(StaticInitializer, FramesSpanTheIntervalAndCarryItsImu) {
  const auto recording = rest(so3::exp({0.1, 0.2, 0.3}), Vector3d::Zero());
  const auto found = initializeAtRest(pointersTo(recording), ImuNoise());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->frames.front().features.stamp, recording.front().frame.stamp);
  EXPECT_EQ(found->frames.back().features.stamp, recording.back().frame.stamp);
  EXPECT_TRUE(found->frames.front().imu.empty());
  double duration = 0.0;
  for (const auto& frame : found->frames) duration += frame.imu.duration();
  EXPECT_NEAR(duration, 0.5, 1e-6);
  // At rest the IMU carries each state to the next.
  const NavState next = found->frames[1].imu.predict(found->frames[0].state, Vector3d(0, 0, -9.81));
  EXPECT_LT(next.T_wb.position.norm(), 1e-6);
  EXPECT_LT(next.v_w.norm(), 1e-5);
}

TEST(StaticInitializer, YawIsTheConventionsAndTiltIsLeftToTheMeasurements) {
  const auto recording = rest(so3::exp({0.0, 0.0, 2.0}), Vector3d::Zero());
  const auto found = initializeAtRest(pointersTo(recording), ImuNoise());
  ASSERT_TRUE(found);
  EXPECT_LT(found->frames[0].state.T_wb.rotation.angularDistance(Eigen::Quaterniond::Identity()),
            1e-6);
  EXPECT_GT(found->sigma(kRotation), 0.1);
  EXPECT_GT(found->sigma(kVelocity), 0.1);
  EXPECT_NEAR(found->sigma(kRotation + 2), 1e-3, 1e-6);
}

TEST(StaticInitializer, WithoutYawKeepsTheTilt) {
  const Eigen::Quaterniond R = so3::exp({0.4, -0.8, 1.3});
  const Eigen::Quaterniond level = withoutYaw(R);
  EXPECT_LT((level.conjugate() * Vector3d::UnitZ() - R.conjugate() * Vector3d::UnitZ()).norm(),
            1e-12);
  EXPECT_LT(withoutYaw(so3::exp({0.0, 0.0, 0.7}) * R).angularDistance(level), 1e-7);
  EXPECT_NEAR(level.z(), 0.0, 1e-12) << "no twist about the vertical";
}

TEST(StaticInitializer, NeedsFramesAndSamples) {
  const auto recording = rest(so3::exp({0.1, 0.2, 0.3}), Vector3d::Zero());
  EXPECT_FALSE(initializeAtRest({}, ImuNoise()));
  EXPECT_FALSE(initializeAtRest({&recording[0]}, ImuNoise()));
  StaticInitializerOptions options;
  options.frames = 1;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::estimator
