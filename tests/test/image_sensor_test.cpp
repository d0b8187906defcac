#include "simulation/image_sensor.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

ImageOptions perfect() {
  ImageOptions options;
  options.lens_blur_px = 0.0;
  options.vignetting = 0.0;
  options.full_well_electrons = 0.0;
  options.read_noise_dn = 0.0;
  return options;
}

cv::Mat flat(double luminance, cv::Size size = {320, 240}) {
  return cv::Mat(size, CV_32FC1, cv::Scalar(luminance));
}

cv::Mat expose(const ImageOptions& options, const cv::Mat& luminance, std::uint64_t seed = 1,
               double t_s = 0.0, std::uint64_t frame = 0) {
  return ImageSensor(options, seed, "cam0").expose(luminance, t_s, frame);
}

double varianceOf(const cv::Mat& image) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  return deviation[0] * deviation[0];
}

/// Correlation of the noise of two images where the second is shifted.
double correlation(const cv::Mat& a, const cv::Mat& b, int dx, int dy) {
  const cv::Rect in_a(8, 8, a.cols - 16, a.rows - 16);
  cv::Mat x, y;
  a(in_a).convertTo(x, CV_64F);
  b(in_a + cv::Point(dx, dy)).convertTo(y, CV_64F);
  x -= cv::mean(x)[0];
  y -= cv::mean(y)[0];
  return x.dot(y) / std::sqrt(x.dot(x) * y.dot(y));
}

TEST(ImageSensor, PerfectOneOnlyQuantizes) {
  EXPECT_EQ(varianceOf(expose(perfect(), flat(0.5))), 0.0);
  EXPECT_EQ(expose(perfect(), flat(0.5)).at<std::uint8_t>(7, 9), 128);
  EXPECT_EQ(expose(perfect(), flat(100.3 / 255)).at<std::uint8_t>(7, 9), 100);
  EXPECT_EQ(expose(perfect(), flat(1.7)).at<std::uint8_t>(7, 9), 255);
}

TEST(ImageSensor, PhotonNoiseGrowsWithTheLightAndTheGain) {
  ImageOptions options = perfect();
  options.full_well_electrons = 2000.0;
  for (const double gain : {1.0, 2.0}) {
    options.gain = gain;
    for (const double grey : {40.0, 120.0, 200.0}) {
      const cv::Mat image = expose(options, flat(grey / gain / 255.0));
      // Rounding to 8 bits adds 1 / 12.
      const double expected = gain * 255.0 * grey / 2000.0 + 1.0 / 12.0;
      // 76800 samples: the variance is known to half a percent.
      EXPECT_NEAR(varianceOf(image), expected, 0.03 * expected) << grey << " gain " << gain;
      EXPECT_NEAR(cv::mean(image)[0], grey, 0.1);
    }
  }
}

TEST(ImageSensor, ReadNoiseIsTheSameAtAnyLight) {
  ImageOptions options = perfect();
  options.read_noise_dn = 2.0;
  for (const double grey : {40.0, 200.0}) {
    EXPECT_NEAR(varianceOf(expose(options, flat(grey / 255.0))), 4.0 + 1.0 / 12.0, 0.1);
  }
}

TEST(ImageSensor, NeighbouringSeedsFramesAndRowsShareNoNoise) {
  ImageOptions options = perfect();
  options.read_noise_dn = 5.0;
  const cv::Mat image = expose(options, flat(0.5), 7);
  const cv::Mat other_seed = expose(options, flat(0.5), 8);
  const cv::Mat other_frame = expose(options, flat(0.5), 7, 0.0, 1);
  for (int dy = -8; dy <= 8; ++dy) {
    for (int dx = -8; dx <= 8; dx += 1) {
      // 68 000 samples: one standard deviation is 0.004, 867 correlations are looked at.
      EXPECT_NEAR(correlation(image, other_seed, dx, dy), 0.0, 0.02) << dx << " " << dy;
      EXPECT_NEAR(correlation(image, other_frame, dx, dy), 0.0, 0.02) << dx << " " << dy;
      if (dx == 0 && dy == 0) continue;
      EXPECT_NEAR(correlation(image, image, dx, dy), 0.0, 0.02) << dx << " " << dy;
    }
  }
}

TEST(ImageSensor, SameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  ImageOptions options;
  const cv::Mat one = expose(options, flat(0.4), 3, 1.0, 12);
  options.threads = 5;
  EXPECT_EQ(cv::norm(one, expose(options, flat(0.4), 3, 1.0, 12), cv::NORM_INF), 0.0);
}

TEST(ImageSensor, VignettingDarkensTheCorners) {
  ImageOptions options = perfect();
  options.vignetting = 0.4;
  const cv::Mat image = expose(options, flat(200.0 / 255.0, {321, 241}));
  EXPECT_EQ(image.at<std::uint8_t>(120, 160), 200);
  EXPECT_EQ(image.at<std::uint8_t>(0, 0), 120);
  EXPECT_EQ(image.at<std::uint8_t>(240, 320), 120);
  const double share = 160.0 * 160.0 / (160.0 * 160.0 + 120.0 * 120.0);
  EXPECT_NEAR(image.at<std::uint8_t>(120, 320), 200.0 * (1.0 - 0.4 * share), 0.5);
}

TEST(ImageSensor, GainDriftsSmoothlyAndSteps) {
  ImageOptions options = perfect();
  options.gain = 1.5;
  options.gain_drift = 0.2;
  options.gain_steps = {{20.0, 0.5}};
  const ImageSensor sensor(options, 1, "cam0");
  double sum = 0.0, squares = 0.0;
  int count = 0;
  for (double t_s = 30.0; t_s < 2000.0; t_s += 0.05, ++count) {
    const double log_gain = std::log(sensor.gainAt(t_s) / 0.75);
    sum += log_gain, squares += log_gain * log_gain;
    // The fastest of the waves: 2 pi / (0.61 * 8 s), twice.
    EXPECT_LT(std::abs(sensor.gainAt(t_s + 0.05) / sensor.gainAt(t_s) - 1.0), 0.03);
  }
  EXPECT_NEAR(sum / count, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / count), 0.2, 0.01);
  EXPECT_NEAR(sensor.gainAt(20.0) / sensor.gainAt(20.0 - 1e-9), 0.5, 1e-6);
  EXPECT_NEAR(cv::mean(sensor.expose(flat(0.3), 40.0, 0))[0], sensor.gainAt(40.0) * 0.3 * 255, 0.5);
}

TEST(ImageSensor, LensBlurSpreadsAPointByItsWidthAndKeepsItsLight) {
  ImageOptions options = perfect();
  options.lens_blur_px = 1.2;
  options.gain = 20.0;
  cv::Mat point = flat(0.0);
  point.at<float>(100, 150) = 0.3F;
  const cv::Mat image = expose(options, point);
  double light = 0.0, moment = 0.0, shift = 0.0;
  for (int y = 80; y < 120; ++y) {
    for (int x = 130; x < 170; ++x) {
      const double grey = image.at<std::uint8_t>(y, x);
      light += grey, moment += grey * (x - 150) * (x - 150), shift += grey * (x - 150);
    }
  }
  EXPECT_NEAR(light, 0.3 * 20 * 255, 0.01 * 0.3 * 20 * 255);
  EXPECT_NEAR(shift / light, 0.0, 1e-9);
  // Cut off at three standard deviations, 8 bits.
  EXPECT_NEAR(std::sqrt(moment / light), 1.2, 0.03);
}

TEST(ImageSensor, BlackoutsHoldTheirInterval) {
  ImageOptions options;
  options.blackouts = {{2.0, 3.0}, {5.0, 5.5}};
  const ImageSensor sensor(options, 1, "cam0");
  EXPECT_FALSE(sensor.isBlackout(1.999));
  EXPECT_TRUE(sensor.isBlackout(2.0));
  EXPECT_TRUE(sensor.isBlackout(2.999));
  EXPECT_FALSE(sensor.isBlackout(3.0));
  EXPECT_TRUE(sensor.isBlackout(5.2));
}

TEST(ImageOptions, RefusesWhatNoCameraDoes) {
  const auto message = [](const ImageOptions& options) -> std::string {
    try {
      options.validate();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(ImageOptions()), "");
  ImageOptions options;
  options.exposure_s = -0.1;
  EXPECT_NE(message(options).find("exposure_s: found -0.1"), std::string::npos);
  options = ImageOptions();
  options.lens_blur_px = std::nan("");
  EXPECT_NE(message(options).find("lens_blur_px"), std::string::npos);
  options = ImageOptions();
  options.blackouts = {{2.0, 1.0}};
  EXPECT_NE(message(options).find("blackouts"), std::string::npos);
  options = ImageOptions();
  options.threads = 0;
  EXPECT_NE(message(options).find("threads"), std::string::npos);
}

TEST(ImageOptions, PrintsEveryOption) {
  std::ostringstream text;
  ImageOptions options;
  options.gain_steps = {{3.0, 0.7}};
  options.blackouts = {{1.0, 2.0}};
  text << options;
  for (const char* expected :
       {"exposure_s: 0.005", "rolling_shutter_readout_s", "lens_blur_px", "vignetting",
        "gain_drift_period_s", "3:0.7", "read_noise_dn", "[1, 2)", "threads: 2"}) {
    EXPECT_NE(text.str().find(expected), std::string::npos) << expected;
  }
}

TEST(ImageSensor, PixelNoiseGrowsWithTheGain) {
  ImageOptions options = perfect();
  options.full_well_electrons = 5000.0;
  options.read_noise_electrons = 20.0;
  for (const double gain : {1.0, 4.0}) {
    options.gain = gain;
    // In the dark there are no photons; half grey, so that nothing is cut off at black.
    const double grey = 128.0;
    const double photons = gain * 255.0 * grey / 5000.0;
    const double pixel = std::pow(gain * 255.0 * 20.0 / 5000.0, 2);
    const double expected = photons + pixel + 1.0 / 12.0;
    EXPECT_NEAR(varianceOf(expose(options, flat(grey / gain / 255.0))), expected, 0.03 * expected);
  }
}

TEST(ImageSensor, FollowsTheSettingsOfAnAutomaticExposure) {
  ImageOptions options = perfect();
  options.exposures = {{1.0, 0.010, 1.0, 1.0}, {2.0, 0.030, 3.0, 2.0}};
  const ImageSensor sensor(options, 1, "cam0");
  EXPECT_EQ(sensor.settingAt(0.0).exposure_s, 0.010);
  EXPECT_NEAR(sensor.settingAt(1.5).exposure_s, 0.020, 1e-12);
  EXPECT_EQ(sensor.settingAt(9.0).exposure_s, 0.030);
  // Three times the light, twice the gain.
  EXPECT_EQ(sensor.expose(flat(0.1), 1.0, 0).at<std::uint8_t>(5, 5), 26);
  EXPECT_EQ(sensor.expose(flat(0.1), 2.0, 0).at<std::uint8_t>(5, 5), 153);
}

}  // namespace
}  // namespace vins::simulation
