#include "vins_estimator/visual/keyframe_choice.h"

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kResolution = 1.0 / 400.0;  ///< [rad/px]

FeatureObservation seen(std::int64_t id, const Vector3d& bearing) {
  FeatureObservation observation;
  observation.id = id;
  observation.bearing = bearing.normalized();
  observation.angular_resolution = kResolution;
  return observation;
}

/// Directions spread over the image.
std::vector<Vector3d> directions() {
  std::vector<Vector3d> result;
  for (int i = 0; i < 30; ++i) result.emplace_back(0.1 * (i % 6 - 3), 0.1 * (i / 6 - 2), 1.0);
  return result;
}

/// Frames 0 and 1 of the same tracks; `turn` takes the bearings of frame 0 to those of frame 1.
Landmarks turnedView(const Quaterniond& turn) {
  FeatureFrame first, second;
  std::int64_t id = 0;
  for (const Vector3d& direction : directions()) {
    first.observations.push_back(seen(id, direction));
    second.observations.push_back(seen(id++, turn * direction));
  }
  Landmarks landmarks(0.5);
  landmarks.addFrame(0, first);
  landmarks.addFrame(1, second);
  return landmarks;
}

/// A rotation that moves the image's centre by so many pixels.
Quaterniond turnByPixels(double pixels) {
  return so3::exp(Vector3d(0.0, pixels * kResolution, 0.0));
}

TEST(ParallaxBetween, TakesTheRotationOut) {
  const Quaterniond turn = so3::exp(Vector3d(0.05, -0.2, 0.1));
  const FrameParallax found = parallaxBetween(turnedView(turn), 0, 1, turn);
  EXPECT_EQ(found.shared, 30);
  EXPECT_LT(found.parallax, 1e-9);
}

TEST(ParallaxBetween, RotatesFromTheFirstFrameToTheSecond) {
  const Quaterniond turn = so3::exp(Vector3d(0.0, 0.1, 0.0));
  const Landmarks landmarks = turnedView(turn);
  // Backwards the frames change places, and with the rotation in the wrong sense it counts twice.
  EXPECT_LT(parallaxBetween(landmarks, 1, 0, turn.conjugate()).parallax, 1e-9);
  EXPECT_GT(parallaxBetween(landmarks, 0, 1, turn.conjugate()).parallax, 60.0);
}

TEST(ParallaxBetween, IsTheMeanShiftInPixels) {
  FeatureFrame first, second;
  for (const std::int64_t id : {0, 1}) first.observations.push_back(seen(id, Vector3d::UnitZ()));
  second.observations.push_back(seen(0, turnByPixels(3.0) * Vector3d::UnitZ()));
  second.observations.push_back(seen(1, turnByPixels(5.0).conjugate() * Vector3d::UnitZ()));
  Landmarks landmarks(0.5);
  landmarks.addFrame(0, first);
  landmarks.addFrame(1, second);
  const FrameParallax found = parallaxBetween(landmarks, 0, 1, Quaterniond::Identity());
  EXPECT_EQ(found.shared, 2);
  // A chord is shorter than its arc by a 24th of the angle squared: 1e-5 here.
  EXPECT_NEAR(found.parallax, 4.0, 1e-4);
}

TEST(ParallaxBetween, CountsTracksThatBothFramesSee) {
  FeatureFrame first, second;
  first.observations = {seen(0, Vector3d::UnitZ()), seen(1, Vector3d::UnitZ())};
  second.observations = {seen(1, Vector3d::UnitZ()), seen(2, Vector3d::UnitX())};
  Landmarks landmarks(0.5);
  landmarks.addFrame(0, first);
  landmarks.addFrame(1, second);
  landmarks.addFrame(2, {});
  const FrameParallax found = parallaxBetween(landmarks, 0, 1, Quaterniond::Identity());
  EXPECT_EQ(found.shared, 1);
  EXPECT_EQ(found.parallax, 0.0);
  const FrameParallax none = parallaxBetween(landmarks, 0, 2, Quaterniond::Identity());
  EXPECT_EQ(none.shared, 0);
  EXPECT_EQ(none.parallax, 0.0) << "no division by zero";
}

const KeyframeChoiceOptions kOptions;  ///< 10 px, half and at least 20 shared, 10 tracks, 2 s

bool isKept(int shared, double parallax, int tracks, double seconds,
            const KeyframeChoiceOptions& options = kOptions) {
  return isKeyframe(options, {shared, parallax}, tracks, seconds);
}

TEST(IsKeyframe, NotForTheSameView) { EXPECT_FALSE(isKept(100, 3.0, 120, 0.5)); }

TEST(IsKeyframe, ForParallax) {
  EXPECT_FALSE(isKept(100, 9.9, 120, 0.5));
  EXPECT_TRUE(isKept(100, 10.0, 120, 0.5));
}

TEST(IsKeyframe, ForFewSharedTracks) {
  EXPECT_FALSE(isKept(60, 0.0, 120, 0.5));
  EXPECT_TRUE(isKept(59, 0.0, 120, 0.5)) << "less than half";
  EXPECT_FALSE(isKept(20, 0.0, 30, 0.5));
  EXPECT_TRUE(isKept(19, 0.0, 30, 0.5)) << "more than half, but less than 20";
}

TEST(IsKeyframe, AfterALongTime) {
  EXPECT_FALSE(isKept(100, 0.0, 120, 1.9));
  EXPECT_TRUE(isKept(100, 0.0, 120, 2.0));
}

TEST(IsKeyframe, ABlindFrameOnlyAfterALongTime) {
  EXPECT_FALSE(isKept(0, 0.0, 9, 0.5));
  EXPECT_FALSE(isKept(9, 50.0, 9, 0.5));
  EXPECT_TRUE(isKept(9, 50.0, 10, 0.5));
  EXPECT_TRUE(isKept(0, 0.0, 0, 2.0));
}

TEST(RestingChoice, MakesKeyframesRareButForMotion) {
  const KeyframeChoiceOptions resting = restingChoice(kOptions);
  EXPECT_TRUE(isKept(30, 0.0, 120, 0.5)) << "moving";
  EXPECT_FALSE(isKept(30, 0.0, 120, 0.5, resting)) << "tracks that come and go";
  EXPECT_FALSE(isKept(100, 0.0, 120, 29.0, resting));
  EXPECT_TRUE(isKept(100, 0.0, 120, 30.0, resting));
  EXPECT_TRUE(isKept(100, 10.0, 120, 0.5, resting)) << "parallax counts as before";
  EXPECT_TRUE(isKept(19, 0.0, 120, 0.5, resting)) << "as does a view that is lost";
}

TEST(KeyframeChoice, DoubtsTheStampOfAnImageThatItsSuccessorFollowsAtOnce) {
  EXPECT_TRUE(isStampDoubtful(0.0985, 0.0015));
  EXPECT_TRUE(isStampDoubtful(0.05, 0.002));
  EXPECT_FALSE(isStampDoubtful(0.05, 0.05));
  EXPECT_FALSE(isStampDoubtful(0.1, 0.033)) << "images that were lost on the way";
  EXPECT_FALSE(isStampDoubtful(0.0, 0.05)) << "of the first frames it is not known";
}

}  // namespace
}  // namespace vins::estimator
