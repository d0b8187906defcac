#include "pose_graph/place/keyframe_view.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "view_fixture.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::pose_graph {
namespace {

using testing::texturedImage;
using testing::textureVocabulary;

class KeyframeViewTest : public ::testing::Test {
 protected:
  /// Points 5 m before the camera on the bearings of a grid of pixels.
  Keyframe keyframe() const {
    Keyframe keyframe;
    keyframe.id = 12;
    keyframe.T_wb = {so3::exp({0.1, -0.2, 0.8}), {1.0, -2.0, 0.5}};
    keyframe.T_bc = {so3::exp({-1.2, 1.2, -1.2}), {0.1, 0.0, 0.02}};
    for (int i = 0; i < 150; ++i) {
      KeyframePoint point;
      point.id = 1000 + i;
      point.pixel = {10.0 + 48.0 * (i % 15), 10.0 + 46.0 * (i / 15)};
      point.bearing = camera_->unproject(point.pixel).value_or(Eigen::Vector3d::UnitZ());
      point.position_w = keyframe.T_wb * (keyframe.T_bc * (5.0 * point.bearing));
      keyframe.points.push_back(point);
    }
    return keyframe;
  }

  const std::shared_ptr<const camera_model::Camera> camera_ =
      vins::camera_model::testing::exampleCameras().front();
  const BriefPattern pattern_ = BriefPattern::generate(1, 49);
  const Vocabulary vocabulary_ = textureVocabulary(pattern_);
};

TEST_F(KeyframeViewTest, HoldsThePointsAndSomeHundredCorners) {
  const ViewDescriber describer(*camera_, vocabulary_, pattern_, {});
  const DescribedView described = describer.describe(keyframe(), texturedImage(752, 480, 1));
  const KeyframeView& view = described.view;
  EXPECT_EQ(view.id, 12);
  EXPECT_EQ(view.points.size(), 150u);
  int of_points = 0;
  for (const ViewFeature& feature : view.features) {
    EXPECT_NEAR(feature.bearing.norm(), 1.0, 1e-6);
    const auto pixel = camera_->project(feature.bearing.cast<double>());
    ASSERT_TRUE(pixel.has_value());
    // Bearings and pixels are single precision: 1e-7 of a unit vector is 5e-5 px.
    EXPECT_NEAR((*pixel - feature.pixel.cast<double>()).norm(), 0.0, 2e-3);
    if (feature.point < 0) continue;
    ++of_points;
    const Eigen::Vector3d p_b = view.points[feature.point].position_b;
    const Eigen::Vector3d p_c = keyframe().T_bc.inverse() * p_b;
    EXPECT_NEAR((p_c - 5.0 * feature.bearing.cast<double>()).norm(), 0.0, 1e-5);
  }
  // All but those at the image's edge: 13 x 9 to 15 x 10 of the grid.
  EXPECT_GE(of_points, 100);
  EXPECT_LT(of_points, 150);
  EXPECT_GE(view.features.size(), 450u);
  EXPECT_LT(view.memory(), 60'000u) << "what a keyframe may take";
  EXPECT_NEAR(view.pixel_angle, 1.0 / 458.654, 1e-5);
}

TEST_F(KeyframeViewTest, IsSortedByNode) {
  ViewOptions options;
  options.direct_index_level = 2;
  const ViewDescriber describer(*camera_, vocabulary_, pattern_, options);
  const auto described = describer.describe(keyframe(), texturedImage(752, 480, 1));
  const auto& features = described.view.features;
  EXPECT_GT(features.back().node, features.front().node);
  EXPECT_TRUE(std::is_sorted(features.begin(), features.end(),
                             [](const auto& a, const auto& b) { return a.node < b.node; }));
  for (const ViewFeature& feature : features) {
    EXPECT_EQ(feature.node, vocabulary_.find(feature.descriptor, 2).node);
  }
}

TEST_F(KeyframeViewTest, TellsImagesApart) {
  const ViewDescriber describer(*camera_, vocabulary_, pattern_, {});
  const auto bag = describer.describe(keyframe(), texturedImage(752, 480, 1)).bag;
  cv::Mat1b noisy = texturedImage(752, 480, 1);
  cv::Mat1b noise(noisy.size());
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 6);
  noisy += noise;
  const auto same = describer.describe(keyframe(), noisy).bag;
  const auto other = describer.describe(keyframe(), texturedImage(752, 480, 2)).bag;
  EXPECT_GT(bagScore(bag, same), 1.5 * bagScore(bag, other));
}

TEST_F(KeyframeViewTest, RefusesImagesOfOtherSizes) {
  const ViewDescriber describer(*camera_, vocabulary_, pattern_, {});
  EXPECT_THROW(describer.describe(keyframe(), texturedImage(640, 480, 1)), InputError);
  EXPECT_THROW(describer.describe(keyframe(), cv::Mat(480, 752, CV_8UC3)), InputError);
  ViewOptions options;
  options.direct_index_level = -1;
  EXPECT_THROW(ViewDescriber(*camera_, vocabulary_, pattern_, options), InputError);
}

TEST_F(KeyframeViewTest, ServesCamerasOfAnyKind) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const ViewDescriber describer(*camera, vocabulary_, pattern_, {});
    const auto size = camera->imageSize();
    const auto described = describer.describe({}, texturedImage(size.width, size.height, 1));
    EXPECT_GE(described.view.features.size(), 200u) << camera->name();
  }
}

}  // namespace
}  // namespace vins::pose_graph
