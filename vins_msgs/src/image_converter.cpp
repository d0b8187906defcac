#include "vins_msgs/image_converter.h"

#include <cstddef>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "encoded_image_size.h"
#include "vins_core/input_error.h"

namespace vins_msgs {
namespace {

constexpr int kIsGrey = -1;

/// How one encoding is stored, and OpenCV's conversion of it to grey values.
struct Encoding {
  const char* name;
  int type;
  int conversion;  ///< a cv::ColorConversionCodes, or kIsGrey
};

// OpenCV names a Bayer pattern by the second row's second and third pixel, ROS by the first two of
// each row.
constexpr Encoding kEncodings[] = {{"mono8", CV_8UC1, kIsGrey},
                                   {"8UC1", CV_8UC1, kIsGrey},
                                   {"mono16", CV_16UC1, kIsGrey},
                                   {"16UC1", CV_16UC1, kIsGrey},
                                   {"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY},
                                   {"8UC3", CV_8UC3, cv::COLOR_BGR2GRAY},
                                   {"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
                                   {"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
                                   {"8UC4", CV_8UC4, cv::COLOR_BGRA2GRAY},
                                   {"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
                                   {"bgr16", CV_16UC3, cv::COLOR_BGR2GRAY},
                                   {"rgb16", CV_16UC3, cv::COLOR_RGB2GRAY},
                                   {"bgra16", CV_16UC4, cv::COLOR_BGRA2GRAY},
                                   {"rgba16", CV_16UC4, cv::COLOR_RGBA2GRAY},
                                   {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2GRAY},
                                   {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2GRAY},
                                   {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2GRAY},
                                   {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2GRAY},
                                   {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2GRAY},
                                   {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2GRAY},
                                   {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2GRAY},
                                   {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2GRAY},
                                   {"yuv422", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
                                   {"uyvy", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
                                   {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
                                   {"yuyv", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2}};

const Encoding* findEncoding(const std::string& name) {
  for (const Encoding& encoding : kEncodings) {
    if (name == encoding.name) return &encoding;
  }
  return nullptr;
}

[[noreturn]] void refuse(const sensor_msgs::Image& message, const std::string& why) {
  throw vins::InputError("image of " + std::to_string(message.width) + "x" +
                         std::to_string(message.height) + " '" + message.encoding +
                         "' cannot be converted to grey values: " + why);
}

const Encoding& encodingOf(const sensor_msgs::Image& message) {
  if (const Encoding* encoding = findEncoding(message.encoding)) return *encoding;
  refuse(message,
         "unknown encoding; allowed: mono8, mono16, 8UC1, 16UC1, bgr, rgb, bgra and rgba with 8 or "
         "16 bits, bayer_* with 8 or 16 bits, yuv422, yuv422_yuy2");
}

void requireWhole(const sensor_msgs::Image& message, std::size_t pixel_size) {
  constexpr std::uint32_t kLargest = 1 << 15;  // pixels a side
  if (message.width == 0 || message.height == 0) refuse(message, "it has no pixels");
  if (message.width > kLargest || message.height > kLargest) refuse(message, "it is too large");
  const std::size_t row = message.width * pixel_size;
  if (message.step < row) {
    refuse(message, "found rows of " + std::to_string(message.step) + " bytes; allowed: at least " +
                        std::to_string(row));
  }
  const std::size_t needed = std::size_t{message.step} * (message.height - 1) + row;
  if (message.data.size() >= needed) return;
  refuse(message, "found " + std::to_string(message.data.size()) +
                      " bytes; needed: " + std::to_string(needed));
}

/// The message's pixels in this machine's (little-endian) byte order; they share the message's
/// memory where nothing has to be swapped.
cv::Mat pixelsOf(const sensor_msgs::Image& message, int type) {
  // OpenCV has no matrix of constant data; what is made of this one is never written.
  auto* data = const_cast<std::uint8_t*>(message.data.data());
  const cv::Mat pixels(static_cast<int>(message.height), static_cast<int>(message.width), type,
                       data, message.step);
  if (message.is_bigendian == 0 || CV_MAT_DEPTH(type) != CV_16U) return pixels;
  cv::Mat swapped = pixels.clone();
  for (int row = 0; row < swapped.rows; ++row) {
    auto* value = swapped.ptr<std::uint16_t>(row);
    for (int i = 0; i < swapped.cols * swapped.channels(); ++i) {
      value[i] = static_cast<std::uint16_t>((value[i] << 8) | (value[i] >> 8));
    }
  }
  return swapped;
}

[[noreturn]] void refuse(const sensor_msgs::CompressedImage& message, const std::string& why) {
  throw vins::InputError("compressed image of format '" + message.format + "' and " +
                         std::to_string(message.data.size()) + " bytes cannot be decoded" + why);
}

/// A few bytes of header can make a decoder ask for gigabytes.
void requireModestSize(const sensor_msgs::CompressedImage& message) {
  constexpr std::uint64_t kMostPixels = 1 << 25;
  const auto size = encodedImageSize(message.data);
  if (!size) refuse(message, ": it is neither JPEG nor PNG");
  if (std::uint64_t{size->width} * size->height <= kMostPixels) return;
  refuse(message, ": it says to be of " + std::to_string(size->width) + "x" +
                      std::to_string(size->height) + "; allowed: at most " +
                      std::to_string(kMostPixels) + " pixels");
}

}  // namespace

cv::Mat ImageConverter::toEightBits(const cv::Mat& grey) {
  double brightest = 0.0;
  cv::minMaxLoc(grey, nullptr, &brightest);
  while (used_bits_ < 16 && brightest >= (1 << used_bits_)) used_bits_ += 2;
  cv::Mat result;
  grey.convertTo(result, CV_8U, 1.0 / (1 << (used_bits_ - 8)));
  return result;
}

cv::Mat ImageConverter::toGrey(const sensor_msgs::Image& message) {
  const Encoding& encoding = encodingOf(message);
  requireWhole(message, static_cast<std::size_t>(CV_ELEM_SIZE(encoding.type)));
  try {
    const cv::Mat pixels = pixelsOf(message, encoding.type);
    cv::Mat grey;
    if (encoding.conversion != kIsGrey) cv::cvtColor(pixels, grey, encoding.conversion);
    if (CV_MAT_DEPTH(encoding.type) == CV_16U) return toEightBits(grey.empty() ? pixels : grey);
    return grey.empty() ? pixels.clone() : grey;
  } catch (const cv::Exception& error) {
    refuse(message, error.what());
  }
}

cv::Mat ImageConverter::toGrey(const sensor_msgs::CompressedImage& message) {
  requireModestSize(message);
  cv::Mat image;
  try {
    // Grey values in the file's depth.
    if (!message.data.empty()) image = cv::imdecode(message.data, cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.type() == CV_16UC1 && !image.empty()) return toEightBits(image);
  if (image.type() == CV_8UC1 && !image.empty()) return image;
  refuse(message, "");
}

}  // namespace vins_msgs
