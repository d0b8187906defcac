#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pose_graph/place/vocabulary.h"

namespace vins::pose_graph {

/// What trainVocabulary() makes.
struct VocabularyTrainingOptions {
  int branching = 10;        ///< children of a node: k
  int levels = 5;            ///< steps from the root to the words: L
  std::uint64_t seed = 1;    ///< same seed and descriptors, same vocabulary
  int iterations = 10;       ///< of the clustering of a node's descriptors, at most
  int fewest_to_split = 10;  ///< descriptors of a node that gets children

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// Makes a vocabulary tree of the descriptors of training images, one list for each image: by
/// k-medians in each node (the median of binary descriptors is the majority of each bit), begun
/// from k-means++ seeds (D. Arthur, S. Vassilvitskii, SODA 2007). The words' weights are inverse
/// document frequencies over the same images. `progress` is told which share of the descriptors,
/// 0 to 1, has found its words; may be empty. Throws InputError where there are fewer than two
/// images with descriptors, or the descriptors are all alike.
Vocabulary trainVocabulary(const std::vector<std::vector<BriefDescriptor>>& images,
                           const VocabularyTrainingOptions& options,
                           const std::function<void(double)>& progress = {});

}  // namespace vins::pose_graph
