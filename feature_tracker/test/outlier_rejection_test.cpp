#include "feature_tracker/outlier_rejection.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vins_core/so3.h"

namespace vins::feature_tracker {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPixel = 1.0 / 460.0;  // [rad]

/// A camera that moves among points; the last `outliers` of the pairs are wrong by 6 to 40 pixels.
struct Scene {
  Quaterniond R_21 = so3::exp({0.01, -0.03, 0.02});
  Vector3d p_21{0.05, -0.02, 0.1};
  double noise = 0.1;   // [px]
  double widest = 1.0;  // of the bearings, tangent
  int outliers = 30;

  std::vector<BearingPair> pairs(int count = 150) const {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::normal_distribution<double> normal;
    std::vector<BearingPair> pairs;
    for (int i = 0; i < count; ++i) {
      const double depth = 4.0 + 3.0 * uniform(random);
      const Vector3d p(widest * uniform(random), widest * uniform(random), 1.0);
      Vector3d second = (R_21 * (depth * p) + p_21).normalized();
      const Vector3d side = second.unitOrthogonal();
      const Vector3d up = second.cross(side);
      second += noise * kPixel * (normal(random) * side + normal(random) * up);
      if (i >= count - outliers) {
        const double angle = 3.14159 * uniform(random);
        const double length = 6.0 + 34.0 * std::abs(uniform(random));
        second += length * kPixel * (std::cos(angle) * side + std::sin(angle) * up);
      }
      pairs.push_back({p.normalized(), second.normalized(), kPixel});
    }
    return pairs;
  }
};

int countInliers(const RejectionResult& result, std::size_t from, std::size_t to) {
  int count = 0;
  for (std::size_t i = from; i < to; ++i) count += result.is_inlier[i];
  return count;
}

void expectGoodJudgement(const Scene& scene, const RejectionResult& result) {
  const std::size_t good = 150 - static_cast<std::size_t>(scene.outliers);
  EXPECT_GE(countInliers(result, 0, good), static_cast<int>(good) * 97 / 100);
  // A wrong pair may lie in its epipolar plane by chance: about one in ten of these.
  EXPECT_LE(countInliers(result, good, 150), scene.outliers / 4);
}

TEST(OutlierRejection, WithTheGyroscopeTellsGoodFromBad) {
  const Scene scene;
  expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), scene.R_21));
}

TEST(OutlierRejection, WithoutTheGyroscopeTellsGoodFromBad) {
  const Scene scene;
  expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), std::nullopt));
}

TEST(OutlierRejection, ServesWideCameras) {
  Scene scene;
  scene.widest = 8.0;
  expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), scene.R_21));
  expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), std::nullopt));
}

TEST(OutlierRejection, IsNotPoisonedByTheGyroscopesBias) {
  const Scene scene;
  // 0.1 rad/s during 50 ms: 2.3 px.
  const Quaterniond biased = so3::exp({0.003, -0.004, 0.001}) * scene.R_21;
  expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), biased));
}

/// The last `movers` pairs see something that moves as one, and not with the camera.
std::vector<BearingPair> pairsAmongMovers(const Scene& scene, int movers, const Vector3d& motion) {
  std::vector<BearingPair> pairs = scene.pairs();
  Scene moved = scene;
  moved.p_21 += motion;
  const std::vector<BearingPair> theirs = moved.pairs();
  std::copy(theirs.end() - movers, theirs.end(), pairs.end() - movers);
  return pairs;
}

TEST(OutlierRejection, IsNotBentByOneThatMovesWhereTheCameraHardlyDoes) {
  Scene scene;
  scene.noise = 0.05;
  scene.outliers = 0;
  scene.p_21 = {0.02, -0.005, 0.01};  // 1 to 9 pixels of parallax, 2 for most
  constexpr int kMovers = 40;
  // A motion between the camera's and this one explains all pairs within a pixel.
  const auto pairs = pairsAmongMovers(scene, kMovers, {0.08, 0.01, 0.0});
  const Quaterniond biased = so3::exp({0.003, -0.003, 0.001}) * scene.R_21;
  for (const std::optional<Quaterniond>& measured :
       {std::optional<Quaterniond>(scene.R_21), std::optional<Quaterniond>(biased),
        std::optional<Quaterniond>()}) {
    const RejectionResult result = OutlierRejection({}).reject(pairs, measured);
    // The threshold is 5 standard deviations or more.
    EXPECT_GE(countInliers(result, 0, 150 - kMovers), 150 - kMovers - 1);
    // Some of them move along their epipolar planes as good pairs do.
    EXPECT_LE(countInliers(result, 150 - kMovers, 150), kMovers / 4);
    EXPECT_LT(result.motion.R_21.angularDistance(scene.R_21), 0.5 * kPixel);
  }
}

TEST(OutlierRejection, KeepsGoodTracksWhereNothingHasParallax) {
  Scene scene;
  for (const Vector3d& p_21 : {Vector3d(0, 0, 0), Vector3d(1e-4, 0, 0)}) {
    scene.p_21 = p_21;
    expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), scene.R_21));
    expectGoodJudgement(scene, OutlierRejection({}).reject(scene.pairs(), std::nullopt));
  }
}

TEST(OutlierRejection, ThresholdIsAtMostTheOneThatWasGiven) {
  Scene scene;
  scene.outliers = 0;
  for (const double noise : {0.02, 0.2, 2.0}) {
    scene.noise = noise;
    OutlierRejectionOptions options;
    const auto pairs = scene.pairs();
    const RejectionResult result = OutlierRejection(options).reject(pairs, scene.R_21);
    EXPECT_LE(result.threshold, options.threshold);
    EXPECT_GE(result.threshold, 0.3 * options.threshold);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (result.is_inlier[i] != 0) {
        EXPECT_LE(epipolarDistance(pairs[i], result.motion), result.threshold);
      }
    }
  }
}

TEST(OutlierRejection, IsTheSameForTheSameSeed) {
  const auto pairs = Scene().pairs();
  OutlierRejection a({}), b({});
  for (int i = 0; i < 3; ++i) {
    const auto first = a.reject(pairs, std::nullopt);
    const auto second = b.reject(pairs, std::nullopt);
    EXPECT_EQ(first.is_inlier, second.is_inlier);
    EXPECT_EQ(first.motion.t_21, second.motion.t_21);
  }
}

TEST(OutlierRejection, DoesNotJudgeAFewPairs) {
  auto pairs = Scene().pairs();
  pairs.erase(pairs.begin(), pairs.end() - 5);
  EXPECT_EQ(OutlierRejection({}).reject(pairs, std::nullopt).inliers, 5);
  EXPECT_EQ(OutlierRejection({}).reject({}, std::nullopt).inliers, 0);
}

TEST(EpipolarDistance, IsThePixelsFromThePlane) {
  const RelativeMotion sideways{Quaterniond::Identity(), Vector3d::UnitX()};
  const Vector3d ahead = Vector3d::UnitZ();
  const BearingPair pair{ahead, Vector3d(0.05, 3.0 * kPixel, 1.0).normalized(), kPixel};
  EXPECT_NEAR(epipolarDistance(pair, sideways), 3.0, 0.02);
  EXPECT_GT(displacement(pair, sideways), 0.0);
}

}  // namespace
}  // namespace vins::feature_tracker
