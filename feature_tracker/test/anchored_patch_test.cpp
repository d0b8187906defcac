#include "feature_tracker/anchored_patch.h"

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "feature_tracker/optical_flow.h"
#include "plane_world.h"
#include "vins_core/so3.h"

namespace vins::feature_tracker {
namespace {

using testing::PlaneWorld;

ImagePyramid pyramidOf(const cv::Mat& image) {
  ImagePyramid pyramid;
  pyramid.build(image, {});
  return pyramid;
}

TEST(AnchoredPatch, FindsTheTurnedAndGrownPatchToATwentiethOfAPixel) {
  const PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  const Pose before;
  const Pose after(so3::exp({0.01, -0.02, 0.1}), {0.02, 0.01, 0.4});
  const ImagePyramid first = pyramidOf(world.render(before));
  const ImagePyramid second = pyramidOf(world.render(after));
  int found = 0, tried = 0;
  for (double v = 100; v < 400; v += 37) {
    for (double u = 150; u < 650; u += 41) {
      const Eigen::Vector2d pixel(u, v);
      const auto expected = world.project(after, *world.pointAt(before, pixel));
      if (!expected || !world.camera().contains(*expected, 20.0)) continue;
      AnchoredPatch patch;
      patch.anchor(first.image(), cv::Point2f(u, v));
      const cv::Point2f start(expected->x() + 0.8, expected->y() - 0.6);
      const PatchAlignment alignment = patch.align(second.image(), start);
      ++tried;
      const double error =
          std::hypot(alignment.pixel.x - expected->x(), alignment.pixel.y - expected->y());
      if (alignment.inside && alignment.correlation > 0.9 && error < 0.05) ++found;
    }
  }
  // Not every place of the texture is a corner, on which alone patches are used.
  EXPECT_GT(tried, 60);
  EXPECT_GT(found, tried * 9 / 10);
}

TEST(AnchoredPatch, DoesNotMindBrightness) {
  const PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  const cv::Mat image = world.render(Pose());
  cv::Mat darker;
  image.convertTo(darker, CV_8U, 0.6, 20.0);
  AnchoredPatch patch;
  patch.anchor(pyramidOf(image).image(), {300.0F, 200.0F});
  const PatchAlignment alignment = patch.align(pyramidOf(darker).image(), {300.7F, 199.5F});
  EXPECT_GT(alignment.correlation, 0.99);
  EXPECT_NEAR(alignment.pixel.x, 300.0, 0.05);
  EXPECT_NEAR(alignment.pixel.y, 200.0, 0.05);
}

TEST(AnchoredPatch, KnowsWhatLooksOtherwise) {
  const PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  const ImagePyramid pyramid = pyramidOf(world.render(Pose()));
  AnchoredPatch patch;
  patch.anchor(pyramid.image(), {300.0F, 200.0F});
  const PatchAlignment alignment = patch.align(pyramid.image(), {420.0F, 330.0F});
  EXPECT_LT(alignment.correlation, 0.9);
}

TEST(AnchoredPatch, SurvivesFlatImagesAndPlacesOutside) {
  const ImagePyramid black = pyramidOf(cv::Mat::zeros(480, 752, CV_8U));
  AnchoredPatch patch;
  patch.anchor(black.image(), {8.0F, 8.0F});
  EXPECT_EQ(patch.align(black.image(), {8.0F, 8.0F}).correlation, 0.0);
  EXPECT_FALSE(patch.align(black.image(), {-500.0F, 8.0F}).inside);
  EXPECT_FALSE(patch.align(black.image(), {std::nanf(""), 8.0F}).inside);
}

}  // namespace
}  // namespace vins::feature_tracker
