#include "simulation/auto_exposure.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "camera_model/pinhole_radtan.h"
#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

/// A wall of one luminance across the whole view.
Scene wall(double luminance) {
  Panel panel;
  panel.centre = {0.0, 0.0, 2.0};
  panel.axis_s = -Vector3d::UnitX();
  panel.axis_t = Vector3d::UnitY();
  panel.half_s = panel.half_t = 50.0;
  panel.texture = std::make_shared<const Texture>(cv::Mat(4, 4, CV_32FC1, cv::Scalar(1.0)));
  panel.light = luminance;
  return Scene({panel}, {}, {}, Eigen::AlignedBox3d(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
}

std::vector<ExposureSetting> settingsBefore(double luminance, const AutoExposure& options = {}) {
  camera_model::CameraParameters p(9);
  p << 450.0, 450.0, 320.0, 180.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  const camera_model::PinholeRadtan camera("cam0", {640, 360}, p);
  return planExposure(
      wall(luminance), camera, [](double) { return Pose(); }, 0.0, 5.0, options);
}

TEST(AutoExposure, BringsTheImageToItsTarget) {
  for (const double luminance : {0.1, 0.3, 0.6}) {
    const ExposureSetting setting = settingsBefore(luminance).back();
    EXPECT_NEAR(luminance * setting.light * setting.gain, AutoExposure().target, 1e-3) << luminance;
    EXPECT_NEAR(setting.light, setting.exposure_s / AutoExposure().reference_s, 1e-12);
  }
}

TEST(AutoExposure, TakesTimeFirstAndGainThen) {
  const ExposureSetting bright = settingsBefore(0.6).back();
  EXPECT_EQ(bright.gain, 1.0);
  EXPECT_LT(bright.exposure_s, 0.010);
  const ExposureSetting dark = settingsBefore(0.05).back();
  EXPECT_EQ(dark.exposure_s, 0.030);
  EXPECT_GT(dark.gain, 2.0);
  EXPECT_EQ(settingsBefore(20.0).back().exposure_s, 0.005);
  EXPECT_EQ(settingsBefore(0.001).back().gain, AutoExposure().max_gain);
}

TEST(AutoExposure, RefusesWhatIsOutOfRange) {
  AutoExposure options;
  options.max_exposure_s = 0.001;
  EXPECT_THROW(settingsBefore(0.5, options), InputError);
  options = {};
  options.target = 1.0;
  EXPECT_THROW(settingsBefore(0.5, options), InputError);
}

}  // namespace
}  // namespace vins::simulation
