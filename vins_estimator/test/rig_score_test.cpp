#include "vins_estimator/window/rig_score.h"

#include <gtest/gtest.h>

#include "synthetic_window.h"

namespace vins::estimator {
namespace {

using testing::makeWindow;
using testing::SyntheticWindow;
using testing::Visibility;

constexpr double kFocalLength = 460.0;  // [px], as makeWindow() has it
constexpr int kHeight = 480;            // [px]
constexpr double kHuber = 1e9;          // no measurement is an outlier here
const Eigen::Vector2d kPrincipalPoint(376.0, 240.0);

/// The pixel of a point whose row is exposed `late` after the frame: motion to second order.
Eigen::Vector2d pixelAt(const WindowFrame& frame, const Pose& T_bc, double focal_length,
                        const Eigen::Vector3d& p_w, double late) {
  const NavState& state = frame.state.value();
  const Eigen::Vector3d rate = frame.measured_rate - state.gyroscope_bias;
  const Pose T_wb(state.T_wb.rotation * so3::exp(Eigen::Vector3d(late * rate)),
                  state.T_wb.position + late * state.v_w);
  const Eigen::Vector3d p_c = (T_wb * T_bc).inverse() * p_w;
  return kPrincipalPoint + focal_length / p_c.z() * p_c.head<2>();
}

RigVector extrinsicAndTime(const RigErrorVector& error) {
  RigVector all = RigVector::Zero();
  all.head<7>() = error.head<7>();
  return all;
}

/// What a camera measures whose rig differs by `error` from the one that the window believes in.
void remeasure(const RigErrorVector& error, const WindowFrame& frame, const SlidingWindow& window,
               const Eigen::Vector3d& p_w, TrackObservation* observation) {
  const RigCalibration rig = plus(window.rig, extrinsicAndTime(error));
  const double focal_length = kFocalLength * (1.0 + error(8));
  Eigen::Vector2d pixel = kPrincipalPoint;
  for (int round = 0; round < 10; ++round) {
    pixel = pixelAt(frame, rig.T_bc, focal_length, p_w, error(6) + error(7) * pixel.y() / kHeight);
  }
  const Eigen::Vector2d normalized = (pixel - kPrincipalPoint) / kFocalLength;
  const Eigen::Vector3d bearing = normalized.homogeneous().normalized();
  observation->pixel = pixel;
  // The root of the area that a pixel covers on the unit sphere.
  observation->angular_resolution = std::pow(bearing.z(), 1.5) / kFocalLength;
  observation->measured.bearing = bearing;
  observation->measured.basis = tangentBasis(bearing);
  observation->measured.inverse_sigma = 1.0 / observation->angular_resolution;
  observation->measured.row = pixel.y() / kHeight;
}

/// States and landmarks are true, and so are the measurements but for the rig's error.
SlidingWindow windowWith(const RigErrorVector& error) {
  const SyntheticWindow synthetic = makeWindow(8, 60, 0.0, [](int) { return Visibility{}; });
  SlidingWindow window = synthetic.window;
  const CameraPoses cameras = window.cameras();
  for (auto& [id, landmark] : window.landmarks.tracks()) {
    const Eigen::Vector3d p_w = positionInWorld(landmark, cameras.at(landmark.host()));
    for (TrackObservation& observation : landmark.observations) {
      const WindowFrame& frame = window.frames[window.indexOf(observation.frame)];
      remeasure(error, frame, window, p_w, &observation);
    }
    landmark.anchor.row = landmark.observations.front().measured.row;
  }
  return window;
}

/// Sizes that are small beside the motion, so that second-order terms are some percent at most.
RigErrorVector smallErrors() {
  RigErrorVector errors;
  errors << 0.01, 0.01, 0.01, 0.005, 0.005, 0.005, 0.002, 0.004, 0.005;
  return errors;
}

TEST(RigScore, FindsEachErrorWithItsSign) {
  for (int i = 0; i < 9; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      RigErrorVector error = RigErrorVector::Zero();
      error(i) = sign * smallErrors()(i);
      const auto score = scoreRig(windowWith(error), kHuber);
      ASSERT_TRUE(score);
      const double found = -score->gradient(i) / score->information(i, i);
      EXPECT_NEAR(found, error(i), 0.05 * std::abs(error(i))) << "error " << i;
    }
  }
}

TEST(RigScore, TellsAllErrorsApartInOneWindow) {
  RigErrorVector error = 0.5 * smallErrors();
  for (int i = 0; i < 9; i += 2) error(i) *= -1.0;
  const auto score = scoreRig(windowWith(error), kHuber);
  ASSERT_TRUE(score);
  const RigErrorVector found = -score->information.ldlt().solve(score->gradient);
  // Products of two errors are of second order, too: a tenth is what they make together.
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(found(i), error(i), 0.1 * std::abs(error(i))) << "error " << i;
  }
}

TEST(RigScore, OfARightRigIsZero) {
  const auto score = scoreRig(windowWith(RigErrorVector::Zero()), kHuber);
  ASSERT_TRUE(score);
  EXPECT_LT(score->cost, 1e-6);
  const RigErrorVector found = -score->information.ldlt().solve(score->gradient);
  EXPECT_LT(found.cwiseAbs().maxCoeff(), 1e-5);
}

TEST(RigScore, DoesNotAskThePast) {
  SlidingWindow window = windowWith(smallErrors());
  const auto with_prior = scoreRig(window, kHuber);
  window.prior = Prior();
  const auto without = scoreRig(window, kHuber);
  ASSERT_TRUE(with_prior && without);
  EXPECT_EQ(with_prior->information, without->information);
  EXPECT_EQ(with_prior->gradient, without->gradient);
}

TEST(RigScore, IsNotMadeOfWindowsAtRest) {
  SlidingWindow window = windowWith(smallErrors());
  window.frames[3].stands_still = true;
  EXPECT_FALSE(scoreRig(window, kHuber));
}

}  // namespace
}  // namespace vins::estimator
