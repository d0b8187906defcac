// Map files, with the checksums of their sections mended.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "fuzz_input.h"
#include "place/binary_file.h"
#include "pose_graph/map/map_file.h"

namespace {

/// Behind 8 bytes of magic and 4 of version: sections of a length, their bytes and a checksum.
std::string withChecksums(std::string bytes) {
  constexpr std::size_t kHead = 12, kNumber = sizeof(std::uint64_t);
  std::uint64_t sum = vins::pose_graph::kChecksumStart;
  std::size_t at = kHead;
  while (at < bytes.size() && bytes.size() - at >= 2 * kNumber) {
    std::uint64_t length = 0;
    std::memcpy(&length, &bytes[at], kNumber);
    at += kNumber;
    if (length > bytes.size() - at - kNumber) break;
    sum = vins::pose_graph::checksum(&bytes[at], length, sum);
    at += length;
    std::memcpy(&bytes[at], &sum, kNumber);
    at += kNumber;
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vins::fuzz::FuzzFolder folder;
  const std::string bytes = withChecksums(vins::fuzz::textOf(data, size));
  vins::fuzz::expectResultOrInputError(
      [&] { vins::pose_graph::readMap(folder.write("fuzz.map", bytes)); });
  return 0;
}
