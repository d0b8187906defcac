// Compressed images.

#include <cstddef>
#include <cstdint>

#include <sensor_msgs/CompressedImage.h>

#include "fuzz_input.h"
#include "vins_msgs/image_converter.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sensor_msgs::CompressedImage message;
  message.format = "jpeg";
  message.data.assign(data, data + size);
  vins::fuzz::expectResultOrInputError([&] { vins_msgs::ImageConverter().toGrey(message); });
  return 0;
}
