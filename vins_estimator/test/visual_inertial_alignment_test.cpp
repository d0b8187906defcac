#include "vins_estimator/initialization/visual_inertial_alignment.h"

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::SyntheticFlight;

/// True up-to-scale structure and IMU of a flight: one unit is `unit` metres.
struct Input {
  std::vector<Pose> T_sc;
  std::vector<Eigen::Quaterniond> R_sb;
  std::vector<Preintegration> imu;
};

Input inputOf(const SyntheticFlight& flight, double unit, int frames = 11, int stride = 4) {
  const auto recording = flight.record(0.0, 0.05 * stride * (frames - 1));
  Input input;
  const Pose T_wc0 = flight.motion(0.0) * flight.T_bc;
  for (int k = 0; k < frames; ++k) {
    Pose T_sc = T_wc0.inverse() * (flight.motion(0.05 * stride * k) * flight.T_bc);
    T_sc.position /= unit;
    input.T_sc.push_back(T_sc);
    input.R_sb.push_back(T_sc.rotation * flight.T_bc.rotation.conjugate());
    Preintegration imu(ImuNoise(), Vector3d::Zero(), Vector3d::Zero());
    for (int i = stride * (k - 1) + 1; k > 0 && i <= stride * k; ++i) {
      imu.integrate(recording[static_cast<std::size_t>(i)].imu);
    }
    input.imu.push_back(imu);
  }
  return input;
}

TEST(GyroscopeBias, IsFound) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.gyroscope_bias = {0.05, -0.08, 0.04};
  const Input input = inputOf(flight, 2.0);
  const auto bias = estimateGyroscopeBias(input.R_sb, input.imu, 0.02);
  ASSERT_TRUE(bias);
  // Midpoint integration at 200 Hz is exact to some 1e-6 rad in 0.2 s.
  EXPECT_LT((*bias - flight.gyroscope_bias).norm(), 1e-4);
}

TEST(GyroscopeBias, RefusesRotationsThatNoBiasExplains) {
  Input input = inputOf(testing::livelyFlight(), 2.0);
  for (std::size_t k = 0; k < input.R_sb.size(); k += 2) {
    input.R_sb[k] = input.R_sb[k] * so3::exp({0.1, 0.0, 0.0});
  }
  EXPECT_FALSE(estimateGyroscopeBias(input.R_sb, input.imu, 0.02));
}

TEST(LinearAlignment, IsExactWithoutNoise) {
  const SyntheticFlight flight = testing::livelyFlight();
  for (const double unit : {0.2, 1.0, 7.0}) {
    const Input input = inputOf(flight, unit);
    const auto linear = alignLinearly(input.T_sc, flight.T_bc, input.imu, 9.81, 0.2);
    ASSERT_TRUE(linear);
    EXPECT_NEAR(linear->scale / unit, 1.0, 1e-3);
    EXPECT_NEAR(linear->free_gravity, 9.81, 0.02);
    const Eigen::Quaterniond R_sw = (flight.motion(0.0) * flight.T_bc).rotation.conjugate();
    EXPECT_LT((linear->g_s - R_sw * Vector3d(0, 0, -9.81)).norm(), 0.01);
    EXPECT_LT((linear->v_s - R_sw * flight.velocity(0.0)).norm(), 5e-3);
  }
}

TEST(LinearAlignment, ToleratesAnAccelerometerBias) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.accelerometer_bias = {0.15, -0.2, 0.15};
  const Input input = inputOf(flight, 2.0);
  const auto linear = alignLinearly(input.T_sc, flight.T_bc, input.imu, 9.81, 0.2);
  ASSERT_TRUE(linear);
  EXPECT_NEAR(linear->scale / 2.0, 1.0, 0.02);
}

TEST(LinearAlignment, KnowsThatConstantVelocityTellsNoScale) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.motion = [](double t) {
    Pose pose = testing::livelyMotion(0.0);
    pose.position = Vector3d(0.0, 0.5 * t, 0.0);
    return pose;
  };
  Input input = inputOf(flight, 2.0);
  for (std::size_t k = 0; k < input.T_sc.size(); ++k) {
    input.T_sc[k].position += 1e-3 * Vector3d(std::sin(17.0 * k), std::sin(31.0 * k), 0.0);
  }
  const auto linear = alignLinearly(input.T_sc, flight.T_bc, input.imu, 9.81, 0.2);
  EXPECT_TRUE(!linear || linear->scale < 0.0 || linear->scale_sigma > 0.3);
}

TEST(Alignment, ChecksOptions) {
  AlignmentOptions options;
  options.joint.yaw_sigma = 0.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::estimator
