#pragma once

#include <cstddef>
#include <deque>

#include <opencv2/core.hpp>

#include "vins_core/time.h"

namespace vins::pose_graph {

/// A keyframe that was chosen longer after its image than this has no image [s].
constexpr double kLongestChoice = 1.0;

/// The last images: a frame is known to be a keyframe only after it. Whoever keeps images keeps
/// them for longer than kLongestChoice, so that live and offline the same keyframes have one.
class RecentImages {
 public:
  /// Keeps the images of the last `span` [s].
  explicit RecentImages(double span) : span_(toNanoseconds(span)) {}

  /// Keeps the image, not a copy of its pixels. A stamp before the last one by a second or more
  /// begins anew; one that is late by less is left out.
  void add(Stamp stamp, const cv::Mat& image);

  /// The image whose stamp is nearest to `stamp`; an empty one where none is within 5 ms, which is
  /// less than any camera's period.
  cv::Mat find(Stamp stamp) const;

  std::size_t size() const { return images_.size(); }

 private:
  struct Entry {
    Stamp stamp;
    cv::Mat image;
  };

  Stamp span_;
  std::deque<Entry> images_;  ///< stamps rise
};

}  // namespace vins::pose_graph
