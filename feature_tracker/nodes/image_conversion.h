#pragma once

#include <opencv2/core.hpp>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

namespace vins::feature_tracker {

/// Brings images of messages to the form that the feature tracker takes: CV_8UC1.
class ImageConversion {
 public:
  /// mono8, 8UC1, mono16, 16UC1, bgr8, rgb8, bgra8, rgba8 and the 8 bit Bayer patterns. 16 bit
  /// images are divided by the power of two that their brightest pixel so far needs, as cameras
  /// fill 10 or 12 of the bits. Throws InputError naming the encoding and those that are allowed,
  /// or what is wrong with the message.
  cv::Mat toGrey(const sensor_msgs::Image& message);

  /// Any format that OpenCV decodes (JPEG, PNG). Throws InputError naming the format.
  cv::Mat toGrey(const sensor_msgs::CompressedImage& message) const;

 private:
  cv::Mat fromSixteenBits(const cv::Mat& image);

  int used_bits_ = 8;
};

}  // namespace vins::feature_tracker
