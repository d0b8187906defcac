#include "camera_model/undistortion.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "camera_model/testing/example_cameras.h"

namespace vins::camera_model {
namespace {

Eigen::Matrix3d intrinsicMatrix(double f, double cx, double cy) {
  Eigen::Matrix3d K;
  K << f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0;
  return K;
}

TEST(UndistortionMap, IsOpencvsForAPinhole) {
  const auto camera = vins::camera_model::testing::exampleCameras()[0];
  const UndistortionMap map =
      makeUndistortionMap(*camera, intrinsicMatrix(400.0, 370.0, 240.0), {752, 480});
  cv::Mat map_x, map_y;
  cv::initUndistortRectifyMap(cv::Matx33d(458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1),
                              cv::Vec4d(-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05),
                              cv::Mat(), cv::Matx33d(400, 0, 370, 0, 400, 240, 0, 0, 1), {752, 480},
                              CV_32FC1, map_x, map_y);
  // Both hold single precision numbers of up to 752.
  EXPECT_LT(cv::norm(map.map_x, map_x, cv::NORM_INF), 2e-4);
  EXPECT_LT(cv::norm(map.map_y, map_y, cv::NORM_INF), 2e-4);
}

TEST(UndistortionMap, LooksAlongTheTurnedAxis) {
  const auto camera = vins::camera_model::testing::exampleCameras()[1];
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const UndistortionMap map =
      makeUndistortionMap(*camera, intrinsicMatrix(100.0, 50.0, 50.0), {101, 101}, R);
  const Eigen::Vector2d expected = *camera->project(R * Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(map.map_x.at<float>(50, 50), expected.x(), 1e-4);
  EXPECT_NEAR(map.map_y.at<float>(50, 50), expected.y(), 1e-4);
}

TEST(UndistortionMap, MarksWhatTheCameraDoesNotSee) {
  const auto camera = vins::camera_model::testing::exampleCameras()[0];
  const Eigen::Matrix3d behind =
      Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const UndistortionMap map =
      makeUndistortionMap(*camera, intrinsicMatrix(100.0, 5.0, 5.0), {11, 11}, behind);
  EXPECT_EQ(map.map_x.at<float>(5, 5), -1.0F);
  EXPECT_EQ(map.map_y.at<float>(0, 10), -1.0F);
}

}  // namespace
}  // namespace vins::camera_model
