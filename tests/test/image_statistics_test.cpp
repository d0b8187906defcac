#include "simulation/image_statistics.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "simulation/random.h"

namespace vins::simulation {
namespace {

ImageStatistics statisticsOf(const cv::Mat& image) {
  ImageStatisticsMeter meter;
  meter.add(image);
  return meter.result();
}

/// Squares of 40 px of two greys.
cv::Mat checkerboard(int dark, int bright) {
  cv::Mat image(360, 640, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>((x / 40 + y / 40) % 2 == 0 ? dark : bright);
    }
  }
  return image;
}

TEST(ImageStatistics, NoiseOfAFlatImageIsItsDeviation) {
  cv::Mat image(360, 640, CV_8UC1);
  Random random(1, "noise");
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(100.0 + 3.0 * random.normal());
    }
  }
  // A low percentile over blocks of 256 pixels lies a little below the deviation.
  EXPECT_NEAR(statisticsOf(image).noise, 3.0, 0.4);
  EXPECT_NEAR(statisticsOf(image).mean_grey, 100.0, 0.2);
}

TEST(ImageStatistics, CountsTheCornersOfACheckerboardByTheirContrast) {
  // 15 x 8 inner corners, and those of the tiles that the image's border cuts count, too.
  const ImageStatistics strong = statisticsOf(checkerboard(60, 180));
  EXPECT_GE(strong.corners[4], 15.0 * 8.0);
  EXPECT_LE(strong.corners[4], 17.0 * 10.0);
  const ImageStatistics faint = statisticsOf(checkerboard(100, 110));
  EXPECT_EQ(faint.corners[3], 0.0);
  EXPECT_GE(faint.corners[0], 15.0 * 8.0);
}

TEST(ImageStatistics, BlurLowersSharpness) {
  cv::Mat blurred;
  cv::GaussianBlur(checkerboard(60, 180), blurred, {}, 2.0);
  EXPECT_LT(statisticsOf(blurred).sharpness, 0.7 * statisticsOf(checkerboard(60, 180)).sharpness);
}

TEST(ImageStatistics, LargeImagesAreHalved) {
  cv::Mat large;
  cv::resize(checkerboard(60, 180), large, {1280, 720}, 0, 0, cv::INTER_NEAREST);
  EXPECT_NEAR(statisticsOf(large).corners[4], statisticsOf(checkerboard(60, 180)).corners[4], 2.0);
}

TEST(TrackCounter, KeepsAllTracksOfASceneAtRestAndNoneInTheDark) {
  TrackCounter counter;
  EXPECT_EQ(counter.add(checkerboard(60, 180)), 0);
  EXPECT_GE(counter.add(checkerboard(60, 180)), 100);
  EXPECT_EQ(counter.add(cv::Mat::zeros(360, 640, CV_8UC1)), 0);
}

}  // namespace
}  // namespace vins::simulation
