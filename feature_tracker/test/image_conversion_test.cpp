#include "image_conversion.h"

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "vins_core/input_error.h"

namespace vins::feature_tracker {
namespace {

sensor_msgs::Image messageOf(const cv::Mat& image, const std::string& encoding) {
  return *cv_bridge::CvImage(std_msgs::Header(), encoding, image).toImageMsg();
}

TEST(ImageConversion, TakesGreyAndColourImages) {
  ImageConversion conversion;
  for (const std::string encoding : {"mono8", "8UC1", "bayer_rggb8"}) {
    const cv::Mat grey(8, 10, CV_8UC1, cv::Scalar(77));
    const cv::Mat out = conversion.toGrey(messageOf(grey, encoding));
    EXPECT_EQ(out.type(), CV_8UC1);
    EXPECT_NEAR(out.at<std::uint8_t>(4, 4), 77, 1) << encoding;
  }
  for (const std::string encoding : {"bgr8", "rgb8"}) {
    const cv::Mat colour(8, 10, CV_8UC3, cv::Scalar(77, 77, 77));
    EXPECT_NEAR(conversion.toGrey(messageOf(colour, encoding)).at<std::uint8_t>(4, 4), 77, 1);
  }
}

TEST(ImageConversion, ScalesSixteenBitsByWhatIsUsed) {
  ImageConversion conversion;
  const cv::Mat twelve_bits(8, 10, CV_16UC1, cv::Scalar(4095));
  EXPECT_EQ(conversion.toGrey(messageOf(twelve_bits, "mono16")).at<std::uint8_t>(0, 0), 255);
  // The scale stays that of the brightest image so far.
  const cv::Mat darker(8, 10, CV_16UC1, cv::Scalar(1600));
  EXPECT_EQ(conversion.toGrey(messageOf(darker, "mono16")).at<std::uint8_t>(0, 0), 100);
}

TEST(ImageConversion, RefusesWithTheEncodingsName) {
  ImageConversion conversion;
  sensor_msgs::Image message = messageOf(cv::Mat(8, 10, CV_32FC1, cv::Scalar(1)), "32FC1");
  try {
    conversion.toGrey(message);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("32FC1"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("mono8"), std::string::npos);
  }
  message = messageOf(cv::Mat(8, 10, CV_8UC1, cv::Scalar(1)), "mono8");
  message.data.resize(7);
  EXPECT_THROW(conversion.toGrey(message), InputError);
}

TEST(ImageConversion, DecodesCompressedImages) {
  sensor_msgs::CompressedImage message;
  message.format = "png";
  cv::imencode(".png", cv::Mat(8, 10, CV_8UC1, cv::Scalar(77)), message.data);
  EXPECT_EQ(ImageConversion().toGrey(message).at<std::uint8_t>(4, 4), 77);
  message.data.resize(10);
  EXPECT_THROW(ImageConversion().toGrey(message), InputError);
  message.data.clear();
  EXPECT_THROW(ImageConversion().toGrey(message), InputError);
}

}  // namespace
}  // namespace vins::feature_tracker
