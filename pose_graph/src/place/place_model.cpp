#include "pose_graph/place/place_model.h"

#include <filesystem>

#include "pose_graph/place/vocabulary_file.h"

namespace vins {

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

}  // namespace vins
