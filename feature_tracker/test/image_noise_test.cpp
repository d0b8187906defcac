#include "feature_tracker/image_noise.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace vins::feature_tracker {
namespace {

/// A ramp with squares on it, and white noise.
cv::Mat noisyImage(double deviation, int seed) {
  cv::Mat1f image(240, 320);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) image(y, x) = 60.0F + 0.3F * x + 0.1F * y;
  }
  cv::RNG random(static_cast<std::uint64_t>(seed));
  for (int i = 0; i < 20; ++i) {
    const cv::Rect square(random.uniform(0, 280), random.uniform(0, 200), 30, 30);
    image(square & cv::Rect(0, 0, 320, 240)) += random.uniform(-30.0, 60.0);
  }
  cv::Mat1f noise(image.size());
  random.fill(noise, cv::RNG::NORMAL, 0.0, deviation);
  cv::Mat result;
  cv::Mat(image + noise).convertTo(result, CV_8U);
  return result;
}

TEST(ImageNoise, IsThatOfTheImageWhateverItShows) {
  for (const double deviation : {0.7, 1.5, 3.0, 6.0}) {
    // Rounding to grey values adds its own.
    const double expected = std::sqrt(deviation * deviation + 1.0 / 12.0);
    EXPECT_NEAR(noiseDeviation(noisyImage(deviation, 1)), expected, 0.12 * expected) << deviation;
  }
}

TEST(ImageNoise, IsAtLeastThatOfRounding) {
  EXPECT_NEAR(noiseDeviation(cv::Mat(100, 100, CV_8U, cv::Scalar(7))), 0.29, 1e-9);
  EXPECT_NEAR(noiseDeviation(cv::Mat(2, 2, CV_8U, cv::Scalar(7))), 0.29, 1e-9);
}

}  // namespace
}  // namespace vins::feature_tracker
