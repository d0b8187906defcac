#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "pose_graph/place/brief.h"
#include "pose_graph/place/vocabulary.h"

namespace vins::pose_graph {

/// By what places are described and told apart. The two belong together: a vocabulary knows only
/// descriptors of the pattern that it was trained with.
struct PlaceModel {
  std::shared_ptr<const Vocabulary> vocabulary;
  std::shared_ptr<const BriefPattern> pattern;
};

/// Checksums by which a stored map tells what it was made with.
struct PlaceModelIdentity {
  std::uint64_t vocabulary = 0;  ///< of the tree, its descriptors and the words' weights
  std::uint64_t pattern = 0;     ///< of all pairs of pixels

  bool operator==(const PlaceModelIdentity& other) const {
    return vocabulary == other.vocabulary && pattern == other.pattern;
  }
};

/// The same for the same content, whatever file it came from. Reads all of the vocabulary: a
/// hundredth of a second.
PlaceModelIdentity identityOf(const PlaceModel& places);

/// Which files to read.
struct PlaceModelFiles {
  std::string vocabulary;  ///< "": brief_k10L5.voc of the shipped ones
  std::string pattern;     ///< "": brief_pattern.yml of the shipped ones

  bool needsShipped() const { return vocabulary.empty() || pattern.empty(); }
};

/// Reads them; `shipped_folder` is the folder of the files that come with this package. Throws
/// InputError naming a file that is not there or broken.
PlaceModel readPlaceModel(const PlaceModelFiles& files, const std::string& shipped_folder);

}  // namespace vins::pose_graph
