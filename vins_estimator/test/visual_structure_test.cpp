#include "vins_estimator/initialization/visual_structure.h"

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/input_error.h"
#include "vins_estimator/initialization/five_point.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::SyntheticFlight;

/// Frames of a flight, with the camera's true turns, falsified by a gyroscope's bias.
struct Frames {
  std::vector<FeatureFrame> features;
  std::vector<Pose> T_wc;
  std::vector<StructureFrame> structure;
};

Frames framesOf(const SyntheticFlight& flight, int count = 10, double interval = 0.15) {
  Frames frames;
  for (int k = 0; k < count; ++k) {
    frames.features.push_back(flight.frameAt(interval * k));
    frames.T_wc.push_back(flight.motion(interval * k) * flight.T_bc);
  }
  for (int k = 0; k < count; ++k) {
    const Eigen::Quaterniond drift = so3::exp(interval * k * flight.gyroscope_bias);
    frames.structure.push_back({&frames.features[k], frames.T_wc[0].rotation.conjugate() *
                                                         frames.T_wc[k].rotation * drift});
  }
  return frames;
}

/// Largest distance of the structure's cameras from the true ones at the best scale, as share of
/// the farthest camera's distance; and the largest rotation error [rad].
std::pair<double, double> errorsOf(const VisualStructure& structure, const Frames& frames) {
  std::vector<Vector3d> truth;
  double numerator = 0.0, denominator = 0.0, rotation = 0.0;
  for (std::size_t k = 0; k < frames.T_wc.size(); ++k) {
    const Pose T_c0_c = frames.T_wc[0].inverse() * frames.T_wc[k];
    truth.push_back(T_c0_c.position);
    numerator += truth[k].dot(structure.T_sc[k].position);
    denominator += truth[k].squaredNorm();
    rotation = std::max(rotation, T_c0_c.rotation.angularDistance(structure.T_sc[k].rotation));
  }
  double position = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Vector3d error = numerator / denominator * truth[k] - structure.T_sc[k].position;
    position = std::max(position, error.norm());
  }
  return {position, rotation};
}

VisualStructure build(const Frames& frames) {
  return buildStructure(frames.structure, 1.0, VisualStructureOptions(), 1);
}

TEST(FivePoint, TrueEssentialMatrixIsAmongTheSolutions) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto points = testing::pointsInBox(5, {-2, -2, 3}, {2, 2, 8}, seed);
    const Pose T_21(so3::exp({0.1, -0.2, 0.05 * seed}), {0.5, 0.2, -0.1});
    Eigen::Matrix<double, 3, 5> first, second;
    for (int i = 0; i < 5; ++i) {
      first.col(i) = points[i].normalized();
      second.col(i) = (T_21 * points[i]).normalized();
    }
    const Eigen::Matrix3d E =
        (so3::hat(T_21.position) * T_21.rotation.toRotationMatrix()).normalized();
    double best = 1.0;
    for (const Eigen::Matrix3d& solution : essentialMatrices(first, second)) {
      best = std::min({best, (solution - E).norm(), (solution + E).norm()});
      EXPECT_NEAR(solution.determinant(), 0.0, 1e-6);
    }
    // The action matrix loses half of the digits in bad configurations.
    EXPECT_LT(best, 1e-6) << "seed " << seed;
  }
}

TEST(VisualStructure, IsExactWithoutNoise) {
  const Frames frames = framesOf(testing::livelyFlight());
  const VisualStructure structure = build(frames);
  ASSERT_TRUE(structure.ok()) << toString(structure.status);
  const auto [position, rotation] = errorsOf(structure, frames);
  // The adjustment stops where the cost falls by less than 1e-4 of itself, far below the noise of
  // one pixel that it assumes.
  EXPECT_LT(position, 1e-3);
  EXPECT_LT(rotation, 1e-3);
  EXPECT_TRUE(structure.T_sc[0].position.isZero(0.0));
}

TEST(VisualStructure, SurvivesOutliersNoiseAndGyroscopeBias) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.pixel_noise = 0.7;
  flight.outlier_share = 0.3;
  flight.gyroscope_bias = {0.05, -0.06, 0.06};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    flight.seed = seed;
    const Frames frames = framesOf(flight);
    const VisualStructure structure = build(frames);
    ASSERT_TRUE(structure.ok()) << toString(structure.status) << ", seed " << seed;
    const auto [position, rotation] = errorsOf(structure, frames);
    EXPECT_LT(position, 0.05);
    EXPECT_LT(rotation, 0.01);
  }
}

TEST(VisualStructure, SurvivesAPlane) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.landmarks_w = testing::pointsInBox(250, {6.0, -5.0, -5.0}, {6.0, 8.0, 5.0});
  flight.pixel_noise = 0.5;
  flight.gyroscope_bias = {0.03, -0.03, 0.03};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    flight.seed = seed;
    const Frames frames = framesOf(flight);
    const VisualStructure structure = build(frames);
    ASSERT_TRUE(structure.ok()) << toString(structure.status) << ", seed " << seed;
    EXPECT_LT(errorsOf(structure, frames).first, 0.1);
  }
}

TEST(VisualStructure, RefusesPureRotationWhateverTheGyroscopeSays) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.pixel_noise = 1.0;
  flight.gyroscope_bias = {0.06, -0.06, 0.05};
  const Pose T_bc = flight.T_bc;
  flight.motion = [T_bc](double t) {
    Pose pose = testing::livelyMotion(2.0 * t);
    pose.position = -(pose.rotation * T_bc.position);  // about the camera's centre
    return pose;
  };
  const VisualStructure structure = build(framesOf(flight));
  EXPECT_EQ(structure.status, StructureStatus::kLittleParallax) << toString(structure.status);
  EXPECT_LT(structure.own_parallax, 4.0);
}

TEST(VisualStructure, RefusesFewTracks) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.landmarks_w.resize(20);
  const VisualStructure structure = build(framesOf(flight));
  EXPECT_EQ(structure.status, StructureStatus::kFewTracks);
  EXPECT_LE(structure.shared, 20);
}

TEST(VisualStructure, SameSeedSameBits) {
  SyntheticFlight flight = testing::livelyFlight();
  flight.pixel_noise = 0.5;
  const Frames frames = framesOf(flight);
  const VisualStructure a = build(frames), b = build(frames);
  ASSERT_TRUE(a.ok() && b.ok());
  for (std::size_t k = 0; k < a.T_sc.size(); ++k) {
    EXPECT_EQ(a.T_sc[k].position, b.T_sc[k].position);
  }
}

TEST(VisualStructure, ChecksOptions) {
  VisualStructureOptions options;
  options.relative_pose.confidence = 1.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::estimator
