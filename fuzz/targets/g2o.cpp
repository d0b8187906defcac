// Pose graphs in g2o's form.

#include <cstddef>
#include <cstdint>
#include <sstream>

#include "fuzz_input.h"
#include "pose_graph/map/g2o_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vins::fuzz::expectResultOrInputError([&] {
    std::istringstream in(vins::fuzz::textOf(data, size));
    const auto graph = vins::pose_graph::readG2o(in, "fuzz.g2o");
    // What could be read can be written and read again.
    std::istringstream again(vins::pose_graph::toG2o(graph));
    vins::pose_graph::readG2o(again, "again.g2o");
  });
  return 0;
}
