// The models against OpenCV's projections of the same cameras.

#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/ccalib/omnidir.hpp>

#include "camera_model/testing/example_cameras.h"

namespace vins::camera_model {
namespace {

using testing::parametersOf;

cv::Matx33d intrinsicMatrix(double fx, double fy, double cx, double cy) {
  return {fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0};
}

using Project = std::function<void(const std::vector<cv::Point3d>&, std::vector<cv::Point2d>*)>;

/// Projects points that the camera sees, within about `spread` of the axis, by both.
void expectAgreement(const Camera& camera, double spread, const Project& project) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-spread, spread);
  std::vector<cv::Point3d> points;
  std::vector<Eigen::Vector2d> pixels;
  while (points.size() < 2000) {
    const Eigen::Vector3d p(uniform(random), uniform(random), 1.0);
    const auto pixel = camera.project(p);
    if (!pixel) continue;
    points.emplace_back(p.x(), p.y(), p.z());
    pixels.push_back(*pixel);
  }
  std::vector<cv::Point2d> expected;
  project(points, &expected);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(pixels[i].x(), expected[i].x, 1e-9) << points[i];
    EXPECT_NEAR(pixels[i].y(), expected[i].y, 1e-9) << points[i];
  }
}

const cv::Vec3d kNoRotation(0.0, 0.0, 0.0), kNoTranslation(0.0, 0.0, 0.0);

TEST(OpencvAgreement, PinholeRadtanIsProjectPoints) {
  const PinholeRadtan camera("pinhole", {752, 480},
                             parametersOf({458.654, 457.296, 367.215, 248.375, -0.28340811,
                                           0.07395907, 0.00019359, 1.76187114e-05, -0.01}));
  expectAgreement(camera, 0.9, [](const auto& points, auto* pixels) {
    const std::vector<double> distortion = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05,
                                            -0.01};
    cv::projectPoints(points, kNoRotation, kNoTranslation,
                      intrinsicMatrix(458.654, 457.296, 367.215, 248.375), distortion, *pixels);
  });
}

TEST(OpencvAgreement, RationalDistortionIsProjectPoints) {
  const PinholeRadtan camera(
      "rational", {640, 480},
      parametersOf({504, 505, 321, 238, 0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43}));
  expectAgreement(camera, 0.9, [](const auto& points, auto* pixels) {
    const std::vector<double> distortion = {0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43};
    cv::projectPoints(points, kNoRotation, kNoTranslation, intrinsicMatrix(504, 505, 321, 238),
                      distortion, *pixels);
  });
}

TEST(OpencvAgreement, KannalaBrandtIsFisheye) {
  const KannalaBrandt camera("fisheye", {512, 512},
                             parametersOf({0.0035, 0.0007, -0.0021, 0.0002, 191, 190, 255, 257}));
  expectAgreement(camera, 5.0, [](const auto& points, auto* pixels) {
    const cv::Vec4d distortion(0.0035, 0.0007, -0.0021, 0.0002);
    cv::fisheye::projectPoints(points, *pixels, kNoRotation, kNoTranslation,
                               intrinsicMatrix(191, 190, 255, 257), distortion);
  });
}

TEST(OpencvAgreement, MeiIsOmnidir) {
  const Mei camera("omni", {640, 480},
                   parametersOf({1.2, -0.12, 0.03, 0.0006, -0.0004, 380, 382, 318, 244}));
  expectAgreement(camera, 4.0, [](const auto& points, auto* pixels) {
    const cv::Vec4d distortion(-0.12, 0.03, 0.0006, -0.0004);
    cv::omnidir::projectPoints(points, *pixels, kNoRotation, kNoTranslation,
                               intrinsicMatrix(380, 382, 318, 244), 1.2, distortion);
  });
}

}  // namespace
}  // namespace vins::camera_model
