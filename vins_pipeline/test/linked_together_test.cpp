// What the estimator does in a program that links the feature tracker too, as run_bag does. Both
// fit rotations to pairs of bearings, with opposite conventions: here each must get its own.

#include <gtest/gtest.h>

#include "feature_tracker/feature_tracker.h"
#include "vins_core/so3.h"
#include "vins_estimator/initialization/relative_pose.h"
#include "vins_estimator/initialization/visual_structure.h"

namespace vins::pipeline {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kResolution = 1.0 / 460.0;  // [rad/px]

std::vector<Vector3d> directions() {
  std::vector<Vector3d> result;
  for (int i = -4; i <= 4; ++i) {
    for (int k = -3; k <= 3; ++k) result.push_back(Vector3d(0.12 * i, 0.11 * k, 1.0).normalized());
  }
  return result;
}

/// What a camera sees that has turned by R_01 and stands where it stood.
FeatureFrame frameOf(Stamp stamp, const Quaterniond& R_01) {
  FeatureFrame frame;
  frame.stamp = stamp;
  std::int64_t id = 0;
  for (const Vector3d& direction : directions()) {
    FeatureObservation observation;
    observation.id = id++;
    observation.bearing = R_01.conjugate() * direction;
    observation.angular_resolution = kResolution;
    frame.observations.push_back(observation);
  }
  return frame;
}

TEST(LinkedTogether, TheEstimatorFitsTheRotationFromTheSecondToTheFirst) {
  const Quaterniond R_12 = so3::exp(Vector3d(0.05, -0.1, 0.2));
  std::vector<estimator::BearingPair> pairs;
  for (const Vector3d& direction : directions()) {
    pairs.push_back({direction, R_12.conjugate() * direction, kResolution});
  }
  EXPECT_LT(estimator::fitRotation(pairs, Quaterniond::Identity()).angularDistance(R_12), 1e-6);
}

TEST(LinkedTogether, ATurnOnTheSpotHasNoParallaxBeyondRotation) {
  // A gyroscope that is off by 0.1 rad a frame: its rotation leaves parallax, the images' own
  // leaves none.
  std::vector<FeatureFrame> features;
  std::vector<estimator::StructureFrame> frames;
  for (int i = 0; i < 6; ++i) features.push_back(frameOf(i, so3::exp(Vector3d(0, 0.04 * i, 0))));
  for (int i = 0; i < 6; ++i) {
    frames.push_back({&features[static_cast<std::size_t>(i)], so3::exp(Vector3d(0, 0.14 * i, 0))});
  }
  const estimator::VisualStructureOptions options;
  const estimator::VisualStructure structure = buildStructure(frames, 1.0, options, 1);
  EXPECT_EQ(structure.status, estimator::StructureStatus::kLittleParallax);
  EXPECT_GT(structure.parallax, options.min_parallax);
  EXPECT_LT(structure.own_parallax, 0.1);
}

TEST(LinkedTogether, TheTrackerIsHereToo) {
  // Keeps the linker from leaving the tracker's library out.
  EXPECT_NO_THROW(feature_tracker::FeatureTrackerOptions().validate());
}

}  // namespace
}  // namespace vins::pipeline
