#include "pose_graph/loop/loop_verifier.h"

#include <cmath>

#include <gtest/gtest.h>

#include "loop_scene.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::LoopScene;

constexpr double kDegree = M_PI / 180.0;

LoopVerification verify(const LoopScene& scene, const LoopVerifierOptions& options = {}) {
  const auto views = scene.views();
  return LoopVerifier(options).verify(views.query, views.old);
}

/// Noise of half a pixel and 3 % of depth, averaged over some 80 points, leaves a tenth of a degree
/// and some centimetres at most; the bounds are about three times that.
void expectTruth(const LoopScene& scene, const LoopVerification& found) {
  EXPECT_TRUE(found.isAccepted()) << found.describe();
  const Pose error = scene.truth().inverse() * found.T_old_query;
  EXPECT_LT(error.position.norm(), 0.1) << found.describe();
  EXPECT_LT(so3::log(error.rotation).norm(), 0.5 * kDegree) << found.describe();
}

TEST(LoopVerifier, FindsTheRelativePose) {
  const LoopScene scene;
  const LoopVerification found = verify(scene);
  expectTruth(scene, found);
  EXPECT_EQ(found.query_id, 40);
  EXPECT_EQ(found.old_id, 3);
  EXPECT_EQ(static_cast<int>(found.features.size()), found.pose_inliers);
  EXPECT_GE(found.pose_inliers, 70);
  EXPECT_NEAR(found.yaw, scene.yaw, 0.5 * kDegree);
  EXPECT_NEAR(found.distance, scene.p_old_query.norm(), 0.1);
  for (const MatchedFeature& feature : found.features) {
    EXPECT_GE(feature.id, 500);
    EXPECT_NEAR(feature.bearing_old.norm(), 1.0, 1e-12);
  }
}

TEST(LoopVerifier, BearsSixtyPercentOfOutliers) {
  for (const double share : {0.2, 0.4, 0.6}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      LoopScene scene;
      scene.seed = seed;
      scene.good = 60;
      scene.wrong = static_cast<int>(std::lround(scene.good * share / (1.0 - share)));
      const LoopVerification found = verify(scene);
      expectTruth(scene, found);
      int wrong = 0;
      for (const MatchedFeature& feature : found.features) wrong += feature.id >= 560 ? 1 : 0;
      // A disc of 6 px about the right place is a three-thousandth of what the camera sees.
      EXPECT_LE(wrong, 2);
    }
  }
}

TEST(LoopVerifier, DoesNotDependOnTheOdometrysYaw) {
  for (const double drift : {-3.0, -1.0, 0.4, 2.5}) {
    LoopScene scene;
    scene.drift_yaw = drift;
    const LoopVerification found = verify(scene);
    expectTruth(scene, found);
    EXPECT_NEAR(found.yaw, scene.yaw, 0.5 * kDegree);
  }
}

TEST(LoopVerifier, ServesStandingStillAndWalkingFar) {
  LoopScene scene;
  scene.yaw = 0.0;
  scene.p_old_query.setZero();
  expectTruth(scene, verify(scene));
  scene.p_old_query = {1.5, -1.0, 0.4};
  expectTruth(scene, verify(scene));
}

TEST(LoopVerifier, ServesCamerasThatSeeBehindThemselves) {
  LoopScene scene;
  scene.half_angle = 1.8;
  scene.good = 120;
  scene.wrong = 60;
  expectTruth(scene, verify(scene));
  const auto views = scene.views();
  int behind = 0;
  for (const auto& feature : views.old.features) behind += feature.bearing.z() <= 0.0F ? 1 : 0;
  EXPECT_GT(behind, 50);
}

TEST(LoopVerifier, BearsAnErrorOfGravity) {
  LoopScene scene;
  scene.gravity_error = {0.5 * kDegree, -0.5 * kDegree, 0.0};
  const LoopVerification found = verify(scene);
  expectTruth(scene, found);
  EXPECT_NEAR(found.tilt, 0.7 * kDegree, 0.4 * kDegree);
}

TEST(LoopVerifier, RejectsWhatContradictsGravity) {
  LoopScene scene;
  scene.gravity_error = {3.0 * kDegree, 0.0, 0.0};
  LoopVerifierOptions options;
  options.max_tilt = 1.0;
  options.epipolar_threshold = options.pose_threshold = 40.0;
  EXPECT_EQ(verify(scene, options).status, LoopStatus::kTilted);
  options.max_tilt = 6.0;
  EXPECT_EQ(verify(scene, options).status, LoopStatus::kAccepted);
}

TEST(LoopVerifier, RejectsOtherPlaces) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    LoopScene scene;
    scene.seed = seed;
    scene.good = 0;
    scene.wrong = 120;
    const LoopVerification found = verify(scene);
    EXPECT_FALSE(found.isAccepted()) << found.describe();
    EXPECT_GE(found.matches.size(), 100u) << "they look alike, and must be told by geometry";
    EXPECT_TRUE(found.features.empty());
  }
}

TEST(LoopVerifier, AcceptsFewMatchesThatAgree) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    LoopScene scene;
    scene.seed = seed;
    scene.good = 18;
    scene.wrong = 6;
    const LoopVerification found = verify(scene);
    EXPECT_TRUE(found.isAccepted()) << found.describe();
    EXPECT_LT((scene.truth().inverse() * found.T_old_query).position.norm(), 0.2);
    // As many among more that contradict them prove less.
    scene.wrong = 30;
    EXPECT_FALSE(verify(scene).isAccepted()) << "seed " << seed;
  }
}

TEST(LoopVerifier, RejectsOtherPlacesWithFewMatches) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    LoopScene scene;
    scene.seed = seed;
    scene.good = 0;
    scene.wrong = 12 + static_cast<int>(seed % 13);
    const LoopVerification found = verify(scene);
    EXPECT_FALSE(found.isAccepted()) << found.describe();
  }
}

TEST(LoopVerifier, RejectsFewMatches) {
  LoopScene scene;
  scene.good = 11;
  EXPECT_EQ(verify(scene).status, LoopStatus::kFewMatches);
  EXPECT_EQ(LoopVerifier({}).verify({}, {}).status, LoopStatus::kFewMatches);
}

TEST(LoopVerifier, RejectsFewInliersAtEachStep) {
  LoopScene scene;
  scene.good = 15;
  scene.wrong = 30;
  LoopVerifierOptions options;
  options.epipolar_threshold = 1.5;
  EXPECT_EQ(verify(scene, options).status, LoopStatus::kFewEpipolarInliers);
  // In epipolar planes, but with depths that are nonsense.
  scene.good = 80;
  scene.wrong = 0;
  scene.depth_noise = 0.9;
  scene.p_old_query = {1.5, -1.5, 0.5};
  options = {};
  options.min_inliers = 60;
  EXPECT_EQ(verify(scene, options).status, LoopStatus::kFewPoseInliers);
}

TEST(LoopVerifier, RejectsImplausiblePoses) {
  LoopScene scene;
  LoopVerifierOptions options;
  options.max_translation = 0.5;
  EXPECT_EQ(verify(scene, options).status, LoopStatus::kFarAway);
  options = {};
  scene.yaw = 45.0 * kDegree;
  EXPECT_FALSE(verify(scene, options).isAccepted());
  options.max_yaw = 60.0;
  EXPECT_TRUE(verify(scene, options).isAccepted());
}

TEST(LoopVerifier, GivesTheSameAnswerAgain) {
  LoopScene scene;
  scene.wrong = 100;
  const auto views = scene.views();
  const LoopVerifier verifier({});
  const LoopVerification a = verifier.verify(views.query, views.old);
  verifier.verify(views.old, views.old);
  const LoopVerification b = verifier.verify(views.query, views.old);
  EXPECT_EQ(a.is_inlier, b.is_inlier);
  EXPECT_EQ(a.T_old_query.position, b.T_old_query.position);
  EXPECT_EQ(a.describe(), b.describe());
}

TEST(LoopVerifier, RefusesBadOptions) {
  LoopVerifierOptions options;
  options.min_inliers = 2;
  EXPECT_THROW(LoopVerifier{options}, InputError);
  options = {};
  options.matching.max_ratio = 0.0;
  EXPECT_THROW(LoopVerifier{options}, InputError);
}

}  // namespace
}  // namespace vins::pose_graph
