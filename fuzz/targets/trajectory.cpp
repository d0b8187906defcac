// Trajectories as text: TUM's form and EuRoC's.

#include <cstddef>
#include <cstdint>
#include <sstream>

#include "fuzz_input.h"
#include "vins_core/trajectory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vins::fuzz::expectResultOrInputError([&] {
    std::istringstream in(vins::fuzz::textOf(data, size));
    vins::readTrajectory(in, "fuzz.txt");
  });
  return 0;
}
