// Bags, and the messages in them.

#include <cstddef>
#include <cstdint>
#include <string>

#include <sensor_msgs/Imu.h>

#include "bag_file.h"
#include "fuzz_input.h"
#include "recorded_message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vins::fuzz::FuzzFolder folder;
  vins::fuzz::expectResultOrInputError([&] {
    vins::pipeline::BagFile bag(folder.write("fuzz.bag", vins::fuzz::textOf(data, size)));
    for (const vins::pipeline::BagMessage& message : bag.takeMessages()) {
      const std::string bytes = bag.read(message);
      using vins::pipeline::readMessage;
      vins::fuzz::expectResultOrInputError([&] { readMessage<sensor_msgs::Image>(bytes); });
      vins::fuzz::expectResultOrInputError([&] { readMessage<sensor_msgs::Imu>(bytes); });
      vins::fuzz::expectResultOrInputError(
          [&] { readMessage<sensor_msgs::CompressedImage>(bytes); });
    }
  });
  return 0;
}
