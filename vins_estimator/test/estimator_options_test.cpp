#include "vins_estimator/estimator_options.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

const char* const kHead = "%YAML:1.0\n";

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
  return readEstimatorOptions(Parameters::parse(kHead + text, "rig.yaml"));
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
                                        "rolling_shutter: 1\nrolling_shutter_tr: 0.033\n"
                                        "image_height: 480\n");
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
  readEstimatorOptions(parameters);
  const auto warnings = parameters.warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], "'window_sise'")) << warnings[0];
}

TEST(EstimatorOptions, VinsMonosNoiseOfASampleBecomesADensity) {
  const std::string vins_mono = "acc_n: 0.08\ngyr_n: 0.004\nacc_w: 0.00004\ngyr_w: 2.0e-6\n";
  const auto noiseOf = [](const std::string& text) {
    return readImuNoise(Parameters::parse(kHead + text, "rig.yaml"));
  };
  const ImuNoise noise = noiseOf(vins_mono);
  EXPECT_NEAR(noise.accelerometer_noise, 0.08 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(noise.gyroscope_noise, 0.004 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(noise.accelerometer_walk, 0.00004 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(noise.gyroscope_walk, 2.0e-6 / std::sqrt(200.0), 1e-15);
  EXPECT_EQ(noise.gravity, 9.81);
  EXPECT_EQ(noiseOf(vins_mono + "imu_noise_unit: density\n").accelerometer_noise, 0.08);
  EXPECT_NEAR(noiseOf(vins_mono + "imu_rate: 400\n").accelerometer_noise, 0.004, 1e-15);
  const std::string small = "acc_n: 0.02\ngyr_n: 0.001\nacc_w: 0.0004\ngyr_w: 2.0e-5\n";
  EXPECT_EQ(noiseOf(small).accelerometer_noise, 0.02);
  EXPECT_NEAR(noiseOf(small + "imu_noise_unit: sample\n").gyroscope_walk, 2e-5 / std::sqrt(200.0),
              1e-15);
}

TEST(EstimatorOptions, ReadsKalibrsFiles) {
  const std::string imu =
      "accelerometer_noise_density: 0.04\naccelerometer_random_walk: 0.003\n"
      "gyroscope_noise_density: 0.0002\ngyroscope_random_walk: 0.00002\nupdate_rate: 200.0\n";
  const std::string camera =
      "cam0:\n  T_cam_imu:\n  - [0.0, 1.0, 0.0, 0.1]\n  - [-1.0, 0.0, 0.0, 0.2]\n"
      "  - [0.0, 0.0, 1.0, 0.3]\n  - [0.0, 0.0, 0.0, 1.0]\n  timeshift_cam_imu: -0.007\n";
  EstimatorOptions options = read(imu + camera);
  EXPECT_EQ(options.imu.accelerometer_noise, 0.04) << "Kalibr's are densities, large ones too";
  EXPECT_EQ(options.imu.gyroscope_walk, 0.00002);
  EXPECT_EQ(options.td, -0.007);
  // The IMU's origin in the camera is (0.1, 0.2, 0.3).
  EXPECT_TRUE((options.T_bc * Eigen::Vector3d(0.1, 0.2, 0.3)).isZero(1e-12));
  EXPECT_TRUE(
      (options.T_bc.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  std::string indented = "imu0:\n";
  std::istringstream lines(imu);
  for (std::string line; std::getline(lines, line);) indented += "  " + line + "\n";
  EXPECT_EQ(read(indented + camera).imu.gyroscope_noise, 0.0002);
}

TEST(EstimatorOptions, TheExtrinsicMayBeAbsentOnlyWhereItIsToBeFound) {
  const EstimatorOptions options = read(std::string("estimate_extrinsic: 2\n") + kDensities);
  EXPECT_EQ(options.extrinsic, ExtrinsicMode::kUnknown);
  EXPECT_TRUE(options.T_bc.position.isZero(0.0));
  for (const std::string mode : {"0", "1"}) {
    const std::string message = messageOf("estimate_extrinsic: " + mode + "\n" + kDensities);
    EXPECT_TRUE(contains(message, "rig.yaml: key 'extrinsicRotation' is missing")) << message;
    EXPECT_TRUE(contains(message, "estimate_extrinsic is 2")) << message;
  }
}

TEST(EstimatorOptions, ErrorsNameFileKeyAndWhatIsAllowed) {
  const std::string good = std::string(kExtrinsic) + kDensities;
  const struct {
    std::string text;
    std::string expected;
  } cases[] = {
      {good + "window_size: 3\n", "'window_size': found '3'; allowed: a whole number from 4 to 30"},
      {good + "window_size: 31\n", "from 4 to 30"},
      {good + "td: 5\n", "'td': found '5'; allowed: a number from -1 to 1"},
      {good + "pixel_noise: 0\n", "'pixel_noise': found '0'"},
      {good + "imu_noise_unit: percent\n", "allowed: auto, density, sample"},
      {good + "max_num_iterations: 0\n", "'max_num_iterations': found '0'"},
      {std::string(kExtrinsic) + "gyr_n: 1\n", "'acc_n' is missing"},
      {std::string("estimate_extrinsic: 3\n") + kDensities, "from 0 to 2"},
      {std::string("extrinsicRotation: [[1, 0, 0], [0, 1, 0], [0, 0, -1]]\n"
                   "extrinsicTranslation: [[0], [0], [0]]\n") +
           kDensities,
       "no rotation (determinant -1)"},
      {std::string("extrinsicRotation: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n") + kDensities,
       "'extrinsicTranslation' is missing"}};
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
