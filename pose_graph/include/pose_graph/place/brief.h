#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pose_graph/place/descriptor.h"

namespace vins::pose_graph {

/// Which pixels about a corner BRIEF compares: 256 pairs of whole-pixel offsets.
/// M. Calonder, V. Lepetit, C. Strecha, P. Fua, "BRIEF: Binary robust independent elementary
/// features", ECCV 2010, section 3.2: both ends of a pair are drawn from a Gaussian about the
/// corner whose variance is 1/25 of the patch's area (their G II, the best of five).
class BriefPattern {
 public:
  /// The bit is set where the image is darker at the first end than at the second.
  struct Pair {
    cv::Point first, second;  ///< offsets from the corner [px]
  };

  /// Draws a pattern inside of a square of `patch_size` pixels; the same for the same seed.
  /// Throws InputError where the size is not 9 to 255.
  static BriefPattern generate(std::uint64_t seed, int patch_size);

  /// Reads an OpenCV YAML file with the integer lists x1, y1, x2, y2 of 256 offsets each, of at
  /// most 127 pixels, as VINS-Mono has it. Throws InputError naming file, key, what was found and
  /// what is allowed.
  static BriefPattern load(const std::string& path);

  /// The text of a file that load() reads.
  std::string toYaml() const;

  const std::array<Pair, kDescriptorBits>& pairs() const { return pairs_; }

  /// The largest offset, in x or y [px].
  int radius() const { return radius_; }

 private:
  explicit BriefPattern(const std::array<Pair, kDescriptorBits>& pairs);

  std::array<Pair, kDescriptorBits> pairs_;
  int radius_ = 0;
};

/// Descriptors of some pixels of an image.
struct DescribedPixels {
  std::vector<std::size_t> indices;          ///< of the pixels that could be described, rising
  std::vector<BriefDescriptor> descriptors;  ///< one for each of `indices`
};

/// Computes BRIEF descriptors: compares the smoothed image's grey values by a pattern, about the
/// nearest whole pixel. Not invariant to rotation about the optical axis and to scale; robust to a
/// little of either. Threads do not change what is computed.
class BriefExtractor {
 public:
  explicit BriefExtractor(const BriefPattern& pattern) : pattern_(pattern) {}

  /// Describes `pixels` of an image (CV_8UC1). A pixel whose pattern would leave the image is left
  /// out. Throws InputError where the image is of another type.
  DescribedPixels describe(const cv::Mat& image, const std::vector<cv::Point2f>& pixels) const;

  /// Pixels that are nearer than this to the image's edge are left out [px].
  int border() const { return pattern_.radius(); }

 private:
  BriefPattern pattern_;
};

}  // namespace vins::pose_graph
