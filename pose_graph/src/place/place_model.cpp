#include "pose_graph/place/place_model.h"

#include <filesystem>

#include "place/binary_file.h"
#include "pose_graph/place/vocabulary_file.h"

namespace vins::pose_graph {
namespace {

template <typename Number>
void include(const Number& number, std::uint64_t* hash) {
  *hash = checksum(reinterpret_cast<const char*>(&number), sizeof(Number), *hash);
}

std::uint64_t identityOf(const Vocabulary& vocabulary) {
  std::uint64_t hash = kChecksumStart;
  include(vocabulary.levels(), &hash);
  for (std::uint32_t node = 0; node < vocabulary.nodeCount(); ++node) {
    include(vocabulary.childCount(node), &hash);
    include(vocabulary.descriptor(node), &hash);
  }
  for (std::uint32_t word = 0; word < vocabulary.wordCount(); ++word) {
    include(vocabulary.weight(word), &hash);
  }
  return hash;
}

std::uint64_t identityOf(const BriefPattern& pattern) {
  std::uint64_t hash = kChecksumStart;
  for (const BriefPattern::Pair& pair : pattern.pairs()) {
    for (const int offset : {pair.first.x, pair.first.y, pair.second.x, pair.second.y}) {
      include(offset, &hash);
    }
  }
  return hash;
}

}  // namespace

PlaceModelIdentity identityOf(const PlaceModel& places) {
  return {identityOf(*places.vocabulary), identityOf(*places.pattern)};
}

PlaceModel readPlaceModel(const PlaceModelFiles& files, const std::string& shipped_folder) {
  const std::filesystem::path folder = shipped_folder;
  const auto chosen = [&](const std::string& file, const char* shipped) {
    return file.empty() ? (folder / shipped).string() : file;
  };
  PlaceModel model;
  model.vocabulary = std::make_shared<const Vocabulary>(
      readVocabulary(chosen(files.vocabulary, "brief_k10L5.voc")));
  model.pattern = std::make_shared<const BriefPattern>(
      BriefPattern::load(chosen(files.pattern, "brief_pattern.yml")));
  return model;
}

}  // namespace vins::pose_graph
