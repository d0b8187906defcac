// The IMU's samples of a folder in the ASL layout.

#include <cstddef>
#include <cstdint>

#include "fuzz_input.h"
#include "vins_pipeline/asl_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vins::fuzz::FuzzFolder folder;
  vins::fuzz::expectResultOrInputError([&] {
    vins::pipeline::readImuCsv(folder.write("data.csv", vins::fuzz::textOf(data, size)));
  });
  return 0;
}
