#pragma once

#include <cstddef>
#include <cstdlib>
#include <deque>
#include <utility>

#include "vins_core/time.h"

namespace vins::pose_graph {

/// A keyframe that was chosen longer after its image than this has no image [s].
constexpr double kLongestChoice = 1.0;

/// The last images: a frame is known to be a keyframe only after it. Whoever keeps images keeps
/// them for longer than kLongestChoice, so that live and offline the same keyframes have one.
///
/// `Image` is a handle that is cheap to copy and empty when default-constructed: a cv::Mat, or the
/// pointer to a message, which is converted for keyframes only.
template <typename Image>
class RecentImages {
 public:
  /// Keeps the images of the last `span` [s].
  explicit RecentImages(double span) : span_(toNanoseconds(span)) {}

  /// Keeps the handle, not a copy of the pixels. A stamp before the last one by a second or more
  /// begins anew; one that is late by less is left out.
  void add(Stamp stamp, Image image) {
    if (!images_.empty() && stamp <= images_.back().stamp) {
      if (images_.back().stamp - stamp < kJump) return;
      images_.clear();
    }
    images_.push_back({stamp, std::move(image)});
    while (stamp - images_.front().stamp > span_) images_.pop_front();
  }

  /// The image whose stamp is nearest to `stamp`; an empty one where none is within 5 ms, which is
  /// less than any camera's period.
  Image find(Stamp stamp) const {
    const Entry* nearest = nullptr;
    for (const Entry& entry : images_) {
      const Stamp distance = std::abs(entry.stamp - stamp);
      if (distance > kTolerance) continue;
      if (nearest == nullptr || distance < std::abs(nearest->stamp - stamp)) nearest = &entry;
    }
    return nearest == nullptr ? Image() : nearest->image;
  }

  std::size_t size() const { return images_.size(); }

 private:
  struct Entry {
    Stamp stamp;
    Image image;
  };

  static constexpr Stamp kTolerance = 5'000'000;  ///< [ns]
  static constexpr Stamp kJump = 1'000'000'000;   ///< back by more, a recording began again [ns]

  Stamp span_;
  std::deque<Entry> images_;  ///< stamps rise
};

}  // namespace vins::pose_graph
