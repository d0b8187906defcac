#include "vins_msgs/camera_info.h"

#include <gtest/gtest.h>

namespace vins_msgs {
namespace {

sensor_msgs::CameraInfo makeInfo() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.K = {500, 0, 321, 0, 501, 243, 0, 0, 1};
  info.D = {-0.3, 0.1, 0.002, -0.001, 0.0};
  // Of a rectified image, which is not to be assumed.
  info.P = {400, 0, 300, 0, 0, 400, 200, 0, 0, 0, 1, 0};
  return info;
}

std::string errorOf(const sensor_msgs::CameraInfo& info) {
  try {
    cameraOf(info, "/left/camera_info");
  } catch (const vins::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CameraInfo, GivesTheCameraOfTheImageThatIsNotRectified) {
  const auto camera = cameraOf(makeInfo(), "/left/camera_info");
  EXPECT_EQ(camera->imageSize(), (vins::camera_model::ImageSize{640, 480}));
  const Eigen::VectorXd parameters = camera->parameters();
  Eigen::VectorXd expected(9);
  expected << 500, 501, 321, 243, -0.3, 0.1, 0.002, -0.001, 0;
  EXPECT_EQ(parameters, expected);
}

TEST(CameraInfo, ARegionOfTheSensorMovesTheCentre) {
  sensor_msgs::CameraInfo info = makeInfo();
  info.roi.x_offset = 100;
  info.roi.y_offset = 40;
  info.roi.width = 400;
  info.roi.height = 300;
  const auto camera = cameraOf(info, "/left/camera_info");
  EXPECT_EQ(camera->imageSize(), (vins::camera_model::ImageSize{400, 300}));
  EXPECT_EQ(camera->parameters()[2], 221);
  EXPECT_EQ(camera->parameters()[3], 203);
}

TEST(CameraInfo, BinningShrinksTheImage) {
  sensor_msgs::CameraInfo info = makeInfo();
  info.binning_x = info.binning_y = 2;
  const auto camera = cameraOf(info, "/left/camera_info");
  EXPECT_EQ(camera->imageSize(), (vins::camera_model::ImageSize{320, 240}));
  EXPECT_EQ(camera->parameters()[0], 250);
  // Pixel centres are whole numbers: (321 + 1/2) / 2 - 1/2.
  EXPECT_EQ(camera->parameters()[2], 160.25);
}

TEST(CameraInfo, ErrorsNameTheTopicAndWhatIsAllowed) {
  sensor_msgs::CameraInfo info = makeInfo();
  info.distortion_model = "thin_prism";
  EXPECT_EQ(errorOf(info),
            "/left/camera_info: camera_info: distortion_model is 'thin_prism'; allowed: plumb_bob, "
            "rational_polynomial, equidistant, fisheye");
  info = makeInfo();
  info.K.fill(0.0);
  EXPECT_EQ(errorOf(info),
            "/left/camera_info: camera_info: K has the focal lengths 0 and 0; allowed: above 0 "
            "(zeros say that the camera is not calibrated)");
}

}  // namespace
}  // namespace vins_msgs
