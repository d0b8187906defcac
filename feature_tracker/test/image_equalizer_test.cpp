#include "feature_tracker/image_equalizer.h"

#include <gtest/gtest.h>

namespace vins::feature_tracker {
namespace {

cv::Mat rampOf(int range) {
  cv::Mat image(480, 752, CV_8U);
  for (int x = 0; x < image.cols; ++x) image.col(x).setTo(20 + x * range / image.cols);
  return image;
}

TEST(GreyRange, IsThatOfTheMiddleEightTenths) {
  EXPECT_NEAR(greyRange(rampOf(100)), 80, 3);
  EXPECT_EQ(greyRange(cv::Mat(480, 752, CV_8U, cv::Scalar(255))), 0);
}

TEST(ImageEqualizer, ActsOnDullImagesWithHysteresis) {
  ImageEqualizer equalizer(Equalization::kWhereDull);
  EXPECT_FALSE(equalizer.decide(rampOf(90)));  // range 72: not dull enough to begin
  EXPECT_TRUE(equalizer.decide(rampOf(50)));
  EXPECT_TRUE(equalizer.decide(rampOf(90)));  // nor vivid enough to end
  EXPECT_FALSE(equalizer.decide(rampOf(150)));
}

TEST(ImageEqualizer, NeverActsWhereItIsOff) {
  ImageEqualizer equalizer(Equalization::kNever);
  EXPECT_FALSE(equalizer.decide(rampOf(10)));
}

}  // namespace
}  // namespace vins::feature_tracker
