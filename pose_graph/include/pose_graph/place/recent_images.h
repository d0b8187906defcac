#pragma once

#include <cstddef>
#include <deque>

#include <opencv2/core.hpp>

#include "vins_core/time.h"

namespace vins::pose_graph {

/// The last images: a frame is known to be a keyframe only after it.
class RecentImages {
 public:
  /// Keeps the last `count` images.
  explicit RecentImages(std::size_t count) : count_(count) {}

  /// Keeps the image, not a copy of its pixels. A stamp before the last one begins anew.
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

  std::size_t count_;
  std::deque<Entry> images_;  ///< stamps rise
};

}  // namespace vins::pose_graph
