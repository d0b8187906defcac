// BRIEF's pattern.

#include <cstddef>
#include <cstdint>

#include "fuzz_input.h"
#include "pose_graph/place/brief.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vins::fuzz::FuzzFolder folder;
  vins::fuzz::expectResultOrInputError([&] {
    vins::pose_graph::BriefPattern::load(
        folder.write("pattern.yml", vins::fuzz::textOf(data, size)));
  });
  return 0;
}
