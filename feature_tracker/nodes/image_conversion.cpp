#include "image_conversion.h"

#include <string>

#include <cv_bridge/cv_bridge.h>
#include <opencv2/imgcodecs.hpp>
#include <sensor_msgs/image_encodings.h>

#include "vins_core/input_error.h"

namespace vins::feature_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;

bool isColour(const std::string& encoding) {
  for (const auto& known : {encodings::BGR8, encodings::RGB8, encodings::BGRA8, encodings::RGBA8,
                            encodings::BAYER_RGGB8, encodings::BAYER_BGGR8, encodings::BAYER_GBRG8,
                            encodings::BAYER_GRBG8}) {
    if (encoding == known) return true;
  }
  return false;
}

}  // namespace

cv::Mat ImageConversion::fromSixteenBits(const cv::Mat& image) {
  double brightest = 0.0;
  cv::minMaxLoc(image, nullptr, &brightest);
  while (used_bits_ < 16 && brightest >= (1 << used_bits_)) ++used_bits_;
  cv::Mat grey;
  image.convertTo(grey, CV_8U, 1.0 / (1 << (used_bits_ - 8)));
  return grey;
}

cv::Mat ImageConversion::toGrey(const sensor_msgs::Image& message) {
  const std::string& encoding = message.encoding;
  try {
    if (encoding == encodings::MONO16 || encoding == encodings::TYPE_16UC1) {
      return fromSixteenBits(cv_bridge::toCvCopy(message)->image);
    }
    if (encoding == encodings::MONO8 || encoding == encodings::TYPE_8UC1) {
      return cv_bridge::toCvCopy(message)->image;
    }
    if (isColour(encoding)) return cv_bridge::toCvCopy(message, encodings::MONO8)->image;
  } catch (const std::exception& error) {
    throw InputError("image of encoding '" + encoding + "' is malformed: " + error.what());
  }
  throw InputError("image encoding '" + encoding +
                   "'; allowed: mono8, 8UC1, mono16, 16UC1, bgr8, rgb8, bgra8, rgba8, bayer_*8");
}

cv::Mat ImageConversion::toGrey(const sensor_msgs::CompressedImage& message) const {
  cv::Mat image;
  try {
    if (!message.data.empty()) image = cv::imdecode(message.data, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (!image.empty()) return image;
  throw InputError("compressed image of format '" + message.format + "' and " +
                   std::to_string(message.data.size()) + " bytes cannot be decoded");
}

}  // namespace vins::feature_tracker
