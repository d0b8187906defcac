#include "feature_tracker/flow_prediction.h"

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "vins_core/so3.h"

namespace vins::feature_tracker {
namespace {

using Eigen::Vector3d;

std::vector<ImuSample> steadyTurn(const Vector3d& rate, Stamp from, Stamp to) {
  std::vector<ImuSample> samples;
  for (Stamp t = from; t <= to; t += 5'000'000) samples.push_back({t, Vector3d::Zero(), rate});
  return samples;
}

TEST(IntegrateGyroscope, OfASteadyTurnIsItsAngle) {
  const Vector3d rate(0.3, -1.2, 2.0);
  const auto R = integrateGyroscope(steadyTurn(rate, 0, 100'000'000), 12'000'000, 61'000'000);
  ASSERT_TRUE(R);
  EXPECT_LT((so3::log(*R) - 0.049 * rate).norm(), 1e-12);
}

TEST(IntegrateGyroscope, NeedsSamplesThatCoverTheTime) {
  const auto samples = steadyTurn({1, 0, 0}, 0, 50'000'000);
  EXPECT_TRUE(integrateGyroscope(samples, 0, 70'000'000));  // extrapolated a little
  EXPECT_FALSE(integrateGyroscope(samples, 0, 100'000'000));
  EXPECT_FALSE(integrateGyroscope({}, 0, 50'000'000));
  EXPECT_FALSE(integrateGyroscope(samples, 50'000'000, 50'000'000));
  auto with_nan = samples;
  with_nan[4].angular_velocity.x() = std::nan("");
  EXPECT_TRUE(integrateGyroscope(with_nan, 0, 50'000'000)->coeffs().allFinite());
}

TEST(IntegrateGyroscope, NeedsNoAcceleration) {
  const auto samples = steadyTurn({1, 0, 0}, 0, 50'000'000);
  auto gyroscope_alone = samples;
  for (ImuSample& sample : gyroscope_alone) sample.acceleration.setConstant(std::nan(""));
  const auto R = integrateGyroscope(gyroscope_alone, 0, 50'000'000);
  ASSERT_TRUE(R);
  EXPECT_EQ(R->coeffs(), integrateGyroscope(samples, 0, 50'000'000)->coeffs());
}

TEST(TurnPrediction, GivesTheProjectionOfPureRotation) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const Eigen::Quaterniond R_bc = so3::exp({0.4, -1.0, 0.7});
    const Vector3d rate(0.5, -0.8, 1.5);
    TurnPrediction prediction(R_bc);
    prediction.addSamples(steadyTurn(rate, 0, 50'000'000));
    const CameraTurn turn = prediction.predict(0, 50'000'000);
    ASSERT_TRUE(turn.measured);
    // A far point stays in the world while the body turns by R_b1b2.
    const Eigen::Quaterniond R_b1b2 = so3::exp(0.05 * rate);
    const Vector3d bearing = Vector3d(0.2, -0.1, 1.0).normalized();
    const Vector3d expected = R_bc.conjugate() * (R_b1b2.conjugate() * (R_bc * bearing));
    const auto pixel = turnedPixel(*camera, bearing, turn.R_21);
    ASSERT_TRUE(pixel) << camera->name();
    EXPECT_LT((*pixel - *camera->project(expected)).norm(), 1e-6) << camera->name();
  }
}

TEST(TurnPrediction, GoesOnAsBeforeWithoutSamples) {
  TurnPrediction prediction(Eigen::Quaterniond::Identity());
  const Vector3d turn(0.01, 0.02, -0.03);
  prediction.learn(so3::exp(turn), 0, 50'000'000);
  const CameraTurn predicted = prediction.predict(50'000'000, 150'000'000);
  EXPECT_FALSE(predicted.measured);
  EXPECT_LT((so3::log(predicted.R_21) - 2.0 * turn).norm(), 1e-12);
}

TEST(AngularResolution, IsTheAngleBetweenNeighbouringPixels) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const Eigen::Vector2d pixel(0.5 * camera->imageSize().width + 60.0,
                                0.5 * camera->imageSize().height - 40.0);
    const Vector3d here = *camera->unproject(pixel);
    const Vector3d right = *camera->unproject(pixel + Eigen::Vector2d(1e-3, 0)) - here;
    const Vector3d below = *camera->unproject(pixel + Eigen::Vector2d(0, 1e-3)) - here;
    const double expected = std::sqrt(right.cross(below).norm()) / 1e-3;
    EXPECT_NEAR(*angularResolution(*camera, here), expected, 1e-4 * expected) << camera->name();
  }
}

}  // namespace
}  // namespace vins::feature_tracker
