#include "vins_estimator/estimator_options.h"

#include <limits>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

const char* const kHead =
    "%YAML:1.0\nmodel_type: PINHOLE\nimage_width: 752\nimage_height: 480\n"
    "projection_parameters: {fx: 460.0, fy: 460.0, cx: 376.0, cy: 240.0}\n"
    "distortion_parameters: {k1: 0.0, k2: 0.0, p1: 0.0, p2: 0.0}\n";

const char* const kExtrinsic = R"(
estimate_extrinsic: 0
extrinsicRotation: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0, -1, 0,
          1, 0, 0,
          0, 0, 1]
extrinsicTranslation: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [-0.02, -0.06, 0.01]
)";

const char* const kDensities = R"(
acc_n: 0.002
gyr_n: 0.00017
acc_w: 0.003
gyr_w: 0.00002
g_norm: 9.81007
)";

EstimatorOptions read(const std::string& text) {
  const Parameters parameters = Parameters::parse(kHead + text, "rig.yaml");
  return readEstimatorOptions(parameters, camera_model::readRig(parameters));
}

std::string messageOf(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(EstimatorOptions, ReadsVinsMonosKeys) {
  const EstimatorOptions options = read(std::string(kExtrinsic) + kDensities +
                                        "td: -0.01\nestimate_td: 1\nmax_solver_time: 0.04\n"
                                        "max_num_iterations: 6\nkeyframe_parallax: 12.5\n"
                                        "rolling_shutter: 1\nrolling_shutter_tr: 0.033\n");
  EXPECT_EQ(options.imu.accelerometer_noise, 0.002);
  EXPECT_EQ(options.imu.gyroscope_noise, 0.00017);
  EXPECT_EQ(options.imu.accelerometer_walk, 0.003);
  EXPECT_EQ(options.imu.gyroscope_walk, 0.00002);
  EXPECT_EQ(options.imu.gravity, 9.81007);
  EXPECT_EQ(options.extrinsic, ExtrinsicMode::kTrusted);
  EXPECT_TRUE(options.T_bc.position.isApprox(Eigen::Vector3d(-0.02, -0.06, 0.01)));
  EXPECT_TRUE(
      (options.T_bc.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_EQ(options.td, -0.01);
  EXPECT_TRUE(options.estimate_td);
  EXPECT_EQ(options.max_solver_time, 0.04);
  EXPECT_EQ(options.max_num_iterations, 6);
  EXPECT_EQ(options.keyframe_parallax, 12.5);
  EXPECT_EQ(options.rolling_shutter_readout, 0.033);
  EXPECT_EQ(options.image_height, 480);
}

TEST(EstimatorOptions, WhatIsAbsentHasDefaults) {
  const EstimatorOptions defaults;
  EstimatorOptions options = read(std::string(kExtrinsic) + kDensities);
  EXPECT_EQ(options.window_size, defaults.window_size);
  EXPECT_EQ(options.pixel_noise, defaults.pixel_noise);
  EXPECT_EQ(options.min_tracks, defaults.min_tracks);
  EXPECT_EQ(options.td, 0.0);
  EXPECT_FALSE(options.estimate_td);
  EXPECT_TRUE(options.first_estimates);
  options = read(std::string(kExtrinsic) + kDensities +
                 "window_size: 15\npixel_noise: 0.6\nmin_tracks: 20\nrolling_shutter_tr: 0.03\n");
  EXPECT_EQ(options.window_size, 15);
  EXPECT_EQ(options.pixel_noise, 0.6);
  EXPECT_EQ(options.min_tracks, 20);
  EXPECT_EQ(options.rolling_shutter_readout, 0.0) << "the shutter is global: no key says otherwise";
}

TEST(EstimatorOptions, KnowsEveryKeyThatItReads) {
  const Parameters parameters = Parameters::parse(
      kHead + std::string(kExtrinsic) + kDensities +
          "td: 0\nestimate_td: 0\nimu_noise_unit: auto\nimu_rate: 200\nwindow_size: 10\n"
          "rolling_shutter: 0\nrolling_shutter_tr: 0\nwindow_sise: 12\n",
      "rig.yaml");
  readEstimatorOptions(parameters, camera_model::readRig(parameters));
  const auto warnings = parameters.warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], "'window_sise'")) << warnings[0];
}

TEST(EstimatorOptions, TakesTheExtrinsicModeOfTheRig) {
  EXPECT_EQ(read(std::string("estimate_extrinsic: 2\n") + kDensities).extrinsic,
            ExtrinsicMode::kUnknown);
  const std::string refined =
      std::string(kExtrinsic).replace(std::string(kExtrinsic).find(": 0"), 3, ": 1");
  EXPECT_EQ(read(refined + kDensities).extrinsic, ExtrinsicMode::kRefined);
}

/// Of a form in which nothing of the rig has VINS-Mono's names.
TEST(EstimatorOptions, TakesTheRigOfAKalibrChain) {
  const Parameters parameters = Parameters::parse(
      "window_size: 12\nrolling_shutter: 1\nrolling_shutter_tr: 0.02\n"
      "cam0: {camera_model: pinhole, distortion_model: radtan, resolution: [752, 480], "
      "intrinsics: [460.0, 460.0, 376.0, 240.0], distortion_coeffs: [0.0, 0.0, 0.0, 0.0], "
      "T_cam_imu: [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "
      "timeshift_cam_imu: 0.007}\nimu0: {accelerometer_noise_density: 0.04}\n",
      "chain.yaml");
  const EstimatorOptions options =
      readEstimatorOptions(parameters, camera_model::readRig(parameters));
  EXPECT_EQ(options.window_size, 12);
  EXPECT_EQ(options.td, 0.007);
  EXPECT_EQ(options.imu.accelerometer_noise, 0.04);
  EXPECT_EQ(options.image_height, 480);
  EXPECT_TRUE(options.T_bc.position.isApprox(Eigen::Vector3d(-0.1, 0.0, 0.0)));
}

TEST(EstimatorOptions, ErrorsNameFileKeyAndWhatIsAllowed) {
  const std::string good = std::string(kExtrinsic) + kDensities;
  const struct {
    std::string text;
    std::string expected;
  } cases[] = {
      {good + "window_size: 3\n", "'window_size': found '3'; allowed: a whole number from 4 to 30"},
      {good + "window_size: 31\n", "from 4 to 30"},
      {good + "pixel_noise: 0\n", "'pixel_noise': found '0'"},
      {good + "max_num_iterations: 0\n", "'max_num_iterations': found '0'"},
      {good + "motion_only_ba: 3\n", "from 0 to 2"}};
  for (const auto& c : cases) {
    const std::string message = messageOf(c.text);
    EXPECT_TRUE(contains(message, c.expected)) << message;
    EXPECT_TRUE(contains(message, "rig.yaml")) << message;
  }
}

TEST(EstimatorOptions, ValidateNamesTheValue) {
  EstimatorOptions options;
  EXPECT_NO_THROW(options.validate());
  options.window_size = 2;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.td = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.T_bc.rotation.coeffs().setZero();
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.imu.gyroscope_noise = 0.0;
  EXPECT_THROW(options.validate(), InputError);
}

TEST(EstimatorOptions, PrintsALinePerOption) {
  std::ostringstream out;
  out << EstimatorOptions();
  EXPECT_TRUE(contains(out.str(), "window_size: 10 keyframes\n")) << out.str();
}

}  // namespace
}  // namespace vins::estimator
