#include "feature_tracker/corner_grid.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "feature_tracker/optical_flow.h"
#include "plane_world.h"

namespace vins::feature_tracker {
namespace {

constexpr camera_model::ImageSize kSize{752, 480};

ImagePyramid texturedPyramid() {
  ImagePyramid pyramid;
  pyramid.build(
      testing::PlaneWorld(vins::camera_model::testing::exampleCameras().front()).render(Pose()),
      {});
  return pyramid;
}

double smallestDistance(const std::vector<cv::Point2f>& pixels) {
  double smallest = 1e9;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      smallest = std::min(smallest, cv::norm(pixels[i] - pixels[k]));
  }
  return smallest;
}

std::vector<cv::Point2f> pixelsOf(const std::vector<Corner>& corners) {
  std::vector<cv::Point2f> pixels;
  for (const Corner& corner : corners) pixels.push_back(corner.pixel);
  return pixels;
}

TEST(CornerGrid, KeepsTheDistanceTheBorderAndTheCount) {
  CornerGrid grid(kSize, {}, {});
  const std::vector<Corner> corners = grid.detect(texturedPyramid().gradients(), {});
  EXPECT_GT(corners.size(), 120U);
  EXPECT_LE(corners.size(), 150U);
  EXPECT_GE(smallestDistance(pixelsOf(corners)), 30.0);
  for (const Corner& corner : corners) EXPECT_TRUE(grid.allows(corner.pixel));
}

TEST(CornerGrid, FillsUpAroundThoseThatAreThere) {
  CornerGrid grid(kSize, {}, {});
  const ImagePyramid pyramid = texturedPyramid();
  std::vector<cv::Point2f> pixels = pixelsOf(grid.detect(pyramid.gradients(), {}));
  pixels.resize(pixels.size() - 40);
  const std::vector<Corner> more = grid.detect(pyramid.gradients(), pixels);
  EXPECT_GT(more.size(), 20U);
  for (const Corner& corner : more) pixels.push_back(corner.pixel);
  EXPECT_GE(smallestDistance(pixels), 30.0);
  EXPECT_LE(pixels.size(), 150U);
}

TEST(CornerGrid, StaysOutOfMaskAndShunnedPlaces) {
  cv::Mat mask(kSize.height, kSize.width, CV_8U, cv::Scalar(255));
  mask(cv::Rect(0, 0, 376, 480)).setTo(0);
  CornerGrid grid(kSize, {}, mask);
  const cv::Point2f shunned(560.0F, 240.0F);
  const auto corners = grid.detect(texturedPyramid().gradients(), {}, {shunned});
  EXPECT_GT(corners.size(), 40U);
  for (const Corner& corner : corners) {
    EXPECT_GE(corner.pixel.x, 375.5F);
    EXPECT_GE(cv::norm(corner.pixel - shunned), 30.0);
  }
}

TEST(CornerGrid, FindsTheCornerOfASquareToAPixel) {
  cv::Mat image(480, 752, CV_8U, cv::Scalar(40));
  image(cv::Rect(300, 200, 100, 100)).setTo(200);
  ImagePyramid pyramid;
  pyramid.build(image, {});
  CornerGrid grid(kSize, {}, {});
  const auto corners = grid.detect(pyramid.gradients(), {});
  ASSERT_EQ(corners.size(), 4U);
  for (const Corner& corner : corners) {
    // The centre of the window's response lies a little inside of the corner itself.
    const float dx = std::min(std::abs(corner.pixel.x - 299.5F), std::abs(corner.pixel.x - 399.5F));
    const float dy = std::min(std::abs(corner.pixel.y - 199.5F), std::abs(corner.pixel.y - 299.5F));
    EXPECT_LT(dx, 3.0F);
    EXPECT_LT(dy, 3.0F);
  }
}

TEST(CornerGrid, LeavesBlankPlacesAloneForThreeImages) {
  // The right half is blank at first.
  const ImagePyramid full = texturedPyramid();
  cv::Mat half_blank = full.image().clone();
  half_blank(cv::Rect(376, 0, 376, 480)).setTo(100);
  ImagePyramid before;
  before.build(half_blank, {});
  CornerGrid grid(kSize, {80, 30.0, 8, 2.5}, {});
  std::vector<cv::Point2f> pixels = pixelsOf(grid.detect(before.gradients(), {}));
  ASSERT_GE(pixels.size(), 40U);  // half of those wanted: below that, every cell is searched
  ASSERT_LT(pixels.size(), 80U);
  // Cells on the border between the halves are not blank: they are up to 94 px wide.
  const auto is_right = [](const cv::Point2f& pixel) { return pixel.x > 376.0F + 94.0F; };
  for (int image = 1; image <= 4; ++image) {
    const auto more = pixelsOf(grid.detect(full.gradients(), pixels));
    EXPECT_EQ(std::any_of(more.begin(), more.end(), is_right), image == 4) << image;
    if (image < 4) continue;
    pixels.insert(pixels.end(), more.begin(), more.end());
  }
  EXPECT_GE(smallestDistance(pixels), 30.0);
}

TEST(CornerGrid, FindsNextToNothingInNoise) {
  cv::Mat1f noise(480, 752);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::NORMAL, 120.0, 1.2);
  cv::Mat image;
  noise.convertTo(image, CV_8U);
  ImagePyramid pyramid;
  pyramid.build(image, {});
  CornerGrid grid(kSize, {}, {});
  EXPECT_LT(grid.detect(pyramid.gradients(), {}, {}, pyramid.noise()).size(), 3U);
}

TEST(CornerGrid, FindsFaintCornersWhereTheImageHasNoNoise) {
  cv::Mat image;
  texturedPyramid().image().convertTo(image, CV_8U, 0.06, 110.0);
  ImagePyramid pyramid;
  pyramid.build(image, {});
  CornerGrid grid(kSize, {}, {});
  EXPECT_GT(grid.detect(pyramid.gradients(), {}, {}, pyramid.noise()).size(), 50U);
  CornerGrid blind(kSize, {}, {});
  EXPECT_LT(blind.detect(pyramid.gradients(), {}).size(), 10U) << "by corner_quality alone";
}

TEST(CornerGrid, TakesShunnedPlacesOnlyWhereCornersAreFew) {
  const ImagePyramid full = texturedPyramid();
  const cv::Point2f shunned(560.0F, 240.0F);
  const auto is_near = [&](const Corner& corner) {
    return cv::norm(corner.pixel - shunned) < 30.0;
  };
  CornerGrid rich(kSize, {}, {});
  const auto many = rich.detect(full.gradients(), {}, {shunned});
  ASSERT_GE(many.size(), 100U);
  EXPECT_TRUE(std::none_of(many.begin(), many.end(), is_near));
  // Only the shunned place and another one show anything.
  cv::Mat image(480, 752, CV_8U, cv::Scalar(100));
  const cv::Rect seen(540, 220, 40, 40), other(100, 100, 40, 40);
  full.image()(other).copyTo(image(other));
  full.image()(seen).copyTo(image(seen));
  ImagePyramid few;
  few.build(image, {});
  CornerGrid poor(kSize, {}, {});
  const auto corners = poor.detect(few.gradients(), {}, {shunned});
  EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), is_near));
  ASSERT_FALSE(corners.empty());
  EXPECT_FALSE(is_near(corners.front())) << "they come last";
}

TEST(CornerGrid, FindsNothingWhereThereIsNothing) {
  ImagePyramid pyramid;
  pyramid.build(cv::Mat(480, 752, CV_8U, cv::Scalar(128)), {});
  CornerGrid grid(kSize, {}, {});
  EXPECT_TRUE(grid.detect(pyramid.gradients(), {}).empty());
}

}  // namespace
}  // namespace vins::feature_tracker
