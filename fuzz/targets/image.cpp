// Image messages: encodings, sizes, steps.

#include <cstddef>
#include <cstdint>
#include <iterator>

#include <sensor_msgs/Image.h>

#include "fuzz_input.h"
#include "vins_msgs/image_converter.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const char* const encodings[] = {
      "mono8",        "8UC1",         "mono16",      "16UC1",       "bgr8",        "8UC3",
      "rgb8",         "bgra8",        "8UC4",        "rgba8",       "bgr16",       "rgb16",
      "bgra16",       "rgba16",       "bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8",
      "bayer_rggb16", "bayer_grbg16", "yuv422",      "yuv422_yuy2", "thermal9",    ""};
  vins::fuzz::Bytes bytes(data, size);
  sensor_msgs::Image message;
  message.encoding = encodings[bytes.byte() % std::size(encodings)];
  message.width = bytes.uint16();
  message.height = bytes.uint16();
  message.step = bytes.uint16();
  message.is_bigendian = bytes.byte();
  message.data = bytes.rest();
  vins::fuzz::expectResultOrInputError([&] { vins_msgs::ImageConverter().toGrey(message); });
  return 0;
}
