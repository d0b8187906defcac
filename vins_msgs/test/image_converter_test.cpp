#include "vins_msgs/image_converter.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "vins_core/input_error.h"

namespace vins_msgs {
namespace {

sensor_msgs::Image messageOf(const cv::Mat& image, const std::string& encoding) {
  sensor_msgs::Image message;
  message.width = static_cast<std::uint32_t>(image.cols);
  message.height = static_cast<std::uint32_t>(image.rows);
  message.encoding = encoding;
  message.step = static_cast<std::uint32_t>(image.step);
  message.data.assign(image.datastart, image.dataend);
  return message;
}

/// An image of one colour in each encoding, and the grey value that it must get.
struct Sample {
  std::string encoding;
  int type;
  cv::Scalar value;
  double grey;
};

TEST(ImageConverter, AcceptsEachEncoding) {
  std::vector<Sample> samples = {{"mono8", CV_8UC1, 77, 77},
                                 {"8UC1", CV_8UC1, 77, 77},
                                 {"bgr8", CV_8UC3, {0, 0, 200}, 0.299 * 200},
                                 {"8UC3", CV_8UC3, {0, 0, 200}, 0.299 * 200},
                                 {"rgb8", CV_8UC3, {200, 0, 0}, 0.299 * 200},
                                 {"bgra8", CV_8UC4, {0, 0, 200, 255}, 0.299 * 200},
                                 {"rgba8", CV_8UC4, {200, 0, 0, 255}, 0.299 * 200},
                                 {"yuv422", CV_8UC2, {128, 77}, 77},
                                 {"yuv422_yuy2", CV_8UC2, {77, 128}, 77},
                                 {"yuyv", CV_8UC2, {77, 128}, 77},
                                 {"mono16", CV_16UC1, 77 * 257, 77},
                                 {"16UC1", CV_16UC1, 77 * 257, 77},
                                 {"bgr16", CV_16UC3, {0, 0, 60000}, 0.299 * 60000 / 256},
                                 {"rgba16", CV_16UC4, {60000, 0, 0, 65535}, 0.299 * 60000 / 256}};
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    samples.push_back({"bayer_" + pattern + "8", CV_8UC1, 77, 77});
    samples.push_back({"bayer_" + pattern + "16", CV_16UC1, 77 * 257, 77});
  }
  for (const Sample& sample : samples) {
    const cv::Mat image(8, 10, sample.type, sample.value);
    const cv::Mat grey = ImageConverter().toGrey(messageOf(image, sample.encoding));
    ASSERT_EQ(grey.type(), CV_8UC1) << sample.encoding;
    ASSERT_EQ(grey.size(), cv::Size(10, 8)) << sample.encoding;
    EXPECT_NEAR(cv::mean(grey)[0], sample.grey, 1.0) << sample.encoding;
  }
}

TEST(ImageConverter, DistinguishesTheBayerPatterns) {
  // A red surface: only the red pixels, at (0, 0) in RGGB, are bright.
  cv::Mat red(8, 10, CV_8UC1, cv::Scalar(0));
  for (int row = 0; row < red.rows; row += 2) {
    for (int col = 0; col < red.cols; col += 2) red.at<std::uint8_t>(row, col) = 200;
  }
  const auto grey = [&](const char* encoding) {
    return double{cv::mean(ImageConverter().toGrey(messageOf(red, encoding)))[0]};
  };
  EXPECT_NEAR(grey("bayer_rggb8"), 0.299 * 200, 2.0);
  EXPECT_NEAR(grey("bayer_bggr8"), 0.114 * 200, 2.0);
}

TEST(ImageConverter, RespectsTheByteOrder) {
  sensor_msgs::Image message = messageOf(cv::Mat(8, 10, CV_16UC1, cv::Scalar(0xFF0F)), "mono16");
  message.is_bigendian = 1;  // the value is 0x0FFF: twelve bits in use
  EXPECT_EQ(ImageConverter().toGrey(message).at<std::uint8_t>(4, 4), 255);
}

TEST(ImageConverter, ScalesSixteenBitsByWhatIsUsed) {
  ImageConverter converter;
  const cv::Mat twelve_bits(8, 10, CV_16UC1, cv::Scalar(4095));
  EXPECT_EQ(converter.toGrey(messageOf(twelve_bits, "mono16")).at<std::uint8_t>(0, 0), 255);
  // The scale stays that of the brightest image so far.
  const cv::Mat darker(8, 10, CV_16UC1, cv::Scalar(1600));
  EXPECT_EQ(converter.toGrey(messageOf(darker, "mono16")).at<std::uint8_t>(0, 0), 100);
}

TEST(ImageConverter, RefusesWithTheEncodingsName) {
  ImageConverter converter;
  sensor_msgs::Image message = messageOf(cv::Mat(8, 10, CV_32FC1, cv::Scalar(1)), "32FC1");
  try {
    converter.toGrey(message);
    FAIL();
  } catch (const vins::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("32FC1"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("mono8"), std::string::npos);
  }
  message = messageOf(cv::Mat(8, 10, CV_8UC1, cv::Scalar(1)), "mono8");
  message.data.resize(7);
  EXPECT_THROW(converter.toGrey(message), vins::InputError);
  message.data.clear();
  EXPECT_THROW(converter.toGrey(message), vins::InputError);
  message.width = message.height = message.step = 0;
  EXPECT_THROW(converter.toGrey(message), vins::InputError);
}

TEST(ImageConverter, DecodesCompressedImages) {
  sensor_msgs::CompressedImage message;
  message.format = "png";
  cv::imencode(".png", cv::Mat(8, 10, CV_8UC1, cv::Scalar(77)), message.data);
  EXPECT_EQ(ImageConverter().toGrey(message).at<std::uint8_t>(4, 4), 77);
  cv::imencode(".png", cv::Mat(8, 10, CV_16UC1, cv::Scalar(1023)), message.data);
  EXPECT_EQ(ImageConverter().toGrey(message).at<std::uint8_t>(4, 4), 255) << "ten bits in use";
  message.data.resize(10);
  EXPECT_THROW(ImageConverter().toGrey(message), vins::InputError);
  message.data.clear();
  EXPECT_THROW(ImageConverter().toGrey(message), vins::InputError);
}

std::string reasonOf(const sensor_msgs::CompressedImage& message) {
  try {
    ImageConverter().toGrey(message);
  } catch (const vins::InputError& error) {
    return error.what();
  }
  return "";
}

/// The size stands in the header: a file of a few bytes would have the decoder ask for gigabytes.
TEST(ImageConverter, RefusesCompressedImagesThatSayToBeHuge) {
  sensor_msgs::CompressedImage message;
  cv::imencode(".png", cv::Mat(8, 10, CV_8UC1, cv::Scalar(77)), message.data);
  message.data[16] = message.data[20] = 1;  // the first of four bytes of width and of height
  EXPECT_NE(reasonOf(message).find("16777226x16777224; allowed: at most 33554432 pixels"),
            std::string::npos)
      << reasonOf(message);
  cv::imencode(".jpg", cv::Mat(8, 10, CV_8UC1, cv::Scalar(77)), message.data);
  EXPECT_EQ(reasonOf(message), "");
  const std::uint8_t size[] = {0, 8, 0, 10};
  const auto place = std::search(message.data.begin(), message.data.end(), size, size + 4);
  ASSERT_NE(place, message.data.end());
  place[0] = place[2] = 0xff;
  EXPECT_NE(reasonOf(message).find("65290x65288; allowed"), std::string::npos) << reasonOf(message);
  cv::imencode(".bmp", cv::Mat(8, 10, CV_8UC1, cv::Scalar(77)), message.data);
  EXPECT_NE(reasonOf(message).find("it is neither JPEG nor PNG"), std::string::npos);
}

}  // namespace
}  // namespace vins_msgs
