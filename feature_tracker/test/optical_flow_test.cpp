#include "feature_tracker/optical_flow.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "camera_model/testing/example_cameras.h"
#include "plane_world.h"

namespace vins::feature_tracker {
namespace {

using testing::PlaneWorld;

/// Corners, at least as far from the border as the motion and the bad predictions below.
std::vector<cv::Point2f> cornersOf(const cv::Mat& image) {
  std::vector<cv::Point2f> all, corners;
  cv::goodFeaturesToTrack(image, all, 300, 0.01, 15.0);
  for (const cv::Point2f& corner : all) {
    if (corner.x > 150 && corner.x < 600 && corner.y > 100 && corner.y < 380) {
      corners.push_back(corner);
    }
  }
  return corners;
}

std::vector<cv::Point2f> gridOfPoints() {
  std::vector<cv::Point2f> points;
  for (int v = 120; v < 380; v += 40) {
    for (int u = 150; u < 620; u += 40) points.emplace_back(u, v);
  }
  return points;
}

TEST(OpticalFlow, FindsPointsAgainEvenFromBadPredictions) {
  const PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  const Pose after(Eigen::Quaterniond::Identity(), {0.15, -0.05, 0.0});
  ImagePyramid first, second;
  const cv::Mat image = world.render(Pose());
  first.build(image, {});
  second.build(world.render(after), {});
  const auto points = cornersOf(image);
  ASSERT_GE(points.size(), 20U);
  // 30 px: what a fast flight without a gyroscope is off by.
  for (const float offset : {0.0F, 30.0F}) {
    std::vector<cv::Point2f> tracked = points;
    for (cv::Point2f& pixel : tracked) pixel.x += offset;
    std::vector<std::uint8_t> found;
    OpticalFlow({}).track(first, second, points, &tracked, &found);
    int good = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto expected =
          world.project(after, *world.pointAt(Pose(), {points[i].x, points[i].y}));
      const double error = std::hypot(tracked[i].x - expected->x(), tracked[i].y - expected->y());
      if (found[i] != 0 && error < 0.5) ++good;
    }
    // With a bad prediction some weak corners are mistaken for others.
    const double least = offset == 0.0F ? 0.9 : 0.75;
    EXPECT_GE(good, least * static_cast<double>(points.size())) << "offset " << offset;
  }
}

TEST(OpticalFlow, FindsNothingInTheDark) {
  const PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  ImagePyramid first, second;
  first.build(world.render(Pose()), {});
  second.build(cv::Mat::zeros(480, 752, CV_8U), {});
  const auto points = gridOfPoints();
  std::vector<cv::Point2f> tracked = points;
  std::vector<std::uint8_t> found;
  OpticalFlow({}).track(first, second, points, &tracked, &found);
  EXPECT_EQ(std::count(found.begin(), found.end(), 1), 0);
}

TEST(BrightnessRatio, IsTheGain) {
  const PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  const cv::Mat image = world.render(Pose());
  cv::Mat brighter;
  image.convertTo(brighter, CV_8U, 1.2);
  ImagePyramid first, second;
  first.build(image, {});
  second.build(brighter, {});
  const auto points = gridOfPoints();
  EXPECT_NEAR(brightnessRatio(first, second, points, points), 1.2, 0.02);
  EXPECT_EQ(brightnessRatio(first, second, {}, {}), 1.0);
}

}  // namespace
}  // namespace vins::feature_tracker
