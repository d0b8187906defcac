#pragma once

#include "camera_model/pinhole_radtan.h"
#include "pose_graph/place/vocabulary_training.h"
#include "textured_image.h"

namespace vins::pose_graph::testing {

/// A vocabulary of textured images, with as many words as tell one from the other: a few thousand.
inline Vocabulary textureVocabulary(const BriefPattern& pattern) {
  std::vector<std::vector<BriefDescriptor>> images;
  const BriefExtractor brief(pattern);
  for (int seed = 100; seed < 108; ++seed) {
    const cv::Mat1b image = texturedImage(752, 480, seed);
    images.push_back(brief.describe(image, findSpreadCorners(image, {}, {})).descriptors);
  }
  VocabularyTrainingOptions options;
  options.branching = 10;
  options.levels = 4;
  options.fewest_to_split = 2;
  return trainVocabulary(images, options);
}

}  // namespace vins::pose_graph::testing
