// Vocabularies: this program's form, with its checksum mended, and VINS-Mono's.

#include <cstddef>
#include <cstdint>
#include <string>

#include "fuzz_input.h"
#include "place/binary_file.h"
#include "pose_graph/place/vocabulary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vins::fuzz::FuzzFolder folder;
  std::string bytes = vins::fuzz::textOf(data, size);
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (bytes.compare(0, 8, "VINSVOCB") == 0 && bytes.size() > kSum) {
    bytes.resize(bytes.size() - kSum);
    vins::pose_graph::append(vins::pose_graph::checksum(bytes.data(), bytes.size()), &bytes);
  }
  vins::fuzz::expectResultOrInputError(
      [&] { vins::pose_graph::readVocabulary(folder.write("fuzz.voc", bytes)); });
  return 0;
}
