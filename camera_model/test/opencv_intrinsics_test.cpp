#include "camera_model/opencv_intrinsics.h"

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

using testing::parametersOf;

OpencvIntrinsics intrinsics(const std::string& model, const std::vector<double>& coefficients) {
  return {model, {640, 480}, 500.0, 501.0, 320.0, 241.0, coefficients};
}

std::string errorOf(const OpencvIntrinsics& wrong) {
  try {
    makeCamera(wrong, "camera");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OpencvIntrinsics, PlumbBobIsAPinholeWithUpToFiveCoefficients) {
  const auto camera = makeCamera(intrinsics("plumb_bob", {-0.3, 0.1, 0.002, -0.001, 0.05}), "left");
  EXPECT_EQ(camera->name(), "left");
  EXPECT_EQ(camera->model(), CameraModel::kPinhole);
  EXPECT_EQ(camera->parameters(),
            parametersOf({500, 501, 320, 241, -0.3, 0.1, 0.002, -0.001, 0.05}));
  EXPECT_EQ(makeCamera(intrinsics("plumb_bob", {-0.3, 0.1, 0, 0}), "c")->parameters(),
            parametersOf({500, 501, 320, 241, -0.3, 0.1, 0, 0, 0}));
  EXPECT_EQ(makeCamera(intrinsics("plumb_bob", {}), "c")->parameters(),
            parametersOf({500, 501, 320, 241, 0, 0, 0, 0, 0}));
}

TEST(OpencvIntrinsics, RationalPolynomialKeepsItsEightCoefficients) {
  const std::vector<double> k = {0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43};
  EXPECT_EQ(makeCamera(intrinsics("rational_polynomial", k), "c")->parameters(),
            parametersOf({500, 501, 320, 241, 0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43}));
  // A denominator of zeros leaves the polynomial, and OpenCV's 14 may end in zeros.
  const std::vector<double> zeros = {-0.3, 0.1, 0, 0, 0.05, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(makeCamera(intrinsics("rational_polynomial", zeros), "c")->parameters(),
            parametersOf({500, 501, 320, 241, -0.3, 0.1, 0, 0, 0.05}));
}

TEST(OpencvIntrinsics, EquidistantAndFisheyeAreKannalaBrandt) {
  for (const char* model : {"equidistant", "fisheye"}) {
    // Some drivers give five, the last of them zero.
    const auto camera = makeCamera(intrinsics(model, {0.01, -0.02, 0.003, 0.0004, 0.0}), "c");
    EXPECT_EQ(camera->model(), CameraModel::kKannalaBrandt);
    EXPECT_EQ(camera->parameters(), parametersOf({0.01, -0.02, 0.003, 0.0004, 500, 501, 320, 241}));
  }
}

TEST(OpencvIntrinsics, RefusesWhatDescribesNoCameraOfOurs) {
  EXPECT_EQ(errorOf(intrinsics("none", {})),
            "distortion_model is 'none'; allowed: plumb_bob, rational_polynomial, equidistant, "
            "fisheye");
  OpencvIntrinsics uncalibrated = intrinsics("plumb_bob", {});
  uncalibrated.fx = uncalibrated.fy = 0.0;
  EXPECT_EQ(errorOf(uncalibrated),
            "K has the focal lengths 0 and 0; allowed: above 0 (zeros say that the camera is not "
            "calibrated)");
  EXPECT_EQ(errorOf(intrinsics("equidistant", {0.1, 0.1, 0.1, 0.1, 0.1})),
            "D has 5 coefficients of the model 'equidistant'; allowed: at most 4 that are not "
            "zero");
  OpencvIntrinsics no_size = intrinsics("plumb_bob", {});
  no_size.size = {0, 0};
  EXPECT_NE(errorOf(no_size), "");
}

TEST(OpencvIntrinsics, DifferencesAreToldWithBothFigures) {
  const PinholeRadtan file("c", {640, 480}, parametersOf({500, 500, 320, 240, 0, 0, 0, 0, 0}));
  const auto difference = [&](ImageSize size, std::initializer_list<double> parameters) {
    return describeDifference(file, PinholeRadtan("t", size, parametersOf(parameters)), "/info");
  };
  EXPECT_FALSE(difference({640, 480}, {503, 499, 325, 236, 0.1, 0, 0, 0, 0}));
  EXPECT_TRUE(difference({640, 480}, {500, 500, 327, 240, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(difference({640, 480}, {500, 506, 320, 240, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(difference({320, 240}, {500, 500, 320, 240, 0, 0, 0, 0, 0}));
  EXPECT_EQ(*difference({1280, 720}, {900, 901, 639, 359, 0, 0, 0, 0, 0}),
            "the file's camera (640 x 480, fx 500, fy 500, cx 320, cy 240) differs from that of "
            "/info (1280 x 720, fx 900, fy 901, cx 639, cy 359): the file's counts; leave it out "
            "to take the topic's");
}

TEST(OpencvIntrinsics, CamerasOfDifferentModelsAreComparedOnTheAxis) {
  const Mei file("c", {640, 480}, parametersOf({1.0, 0, 0, 0, 0, 1000, 1000, 320, 240}));
  const PinholeRadtan alike("t", {640, 480}, parametersOf({500, 500, 320, 240, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(describeDifference(file, alike, "/info"));
}

}  // namespace
}  // namespace vins::camera_model
