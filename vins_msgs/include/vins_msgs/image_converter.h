#pragma once

#include <opencv2/core.hpp>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

namespace vins_msgs {

/// Converts image messages to grey values, CV_8UC1. One converter per image topic: it remembers the
/// bit depth that the topic's images use.
class ImageConverter {
 public:
  /// Accepts mono8, 8UC1, mono16, 16UC1, bgr, rgb, bgra and rgba with 8 or 16 bits (8UC3 and 8UC4
  /// are taken as bgr8 and bgra8), the Bayer patterns with 8 or 16 bits, yuv422 (UYVY) and
  /// yuv422_yuy2 (YUYV). Values of 16 bits are divided by the bit depth in use: the smallest of 8,
  /// 10, 12, 14 and 16 that holds the brightest pixel of all images so far. Throws
  /// vins::InputError naming size, encoding and reason.
  cv::Mat toGrey(const sensor_msgs::Image& message);

  /// Accepts what ROS compresses to: JPEG, and PNG with 8 or 16 bits, of at most 2^25 pixels.
  /// Throws vins::InputError naming format, size and reason.
  cv::Mat toGrey(const sensor_msgs::CompressedImage& message);

 private:
  cv::Mat toEightBits(const cv::Mat& grey);

  int used_bits_ = 8;  ///< rises only, so that the scale is steady
};

}  // namespace vins_msgs
