#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Geometry>

#include "feature_tracker/feature_track.h"

namespace vins::feature_tracker {

/// The camera's turns between the last images.
class MotionMemory {
 public:
  /// R_21 from the latest image to a new one.
  void add(const Eigen::Quaterniond& R_21) {
    ++image_;
    turns_[image_ % kSize] = R_21;
  }

  /// Number of the latest image.
  std::uint32_t image() const { return image_; }

  /// The turn since `images` ago, at most kMemory - 1.
  Eigen::Quaterniond turnSince(std::uint32_t images) const {
    Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
    for (std::uint32_t i = images; i > 0; --i) R = turns_[(image_ + 1 - i) % kSize] * R;
    return R.normalized();
  }

 private:
  static constexpr std::uint32_t kSize = FeatureTrack::kMemory;
  std::array<Eigen::Quaterniond, kSize> turns_;
  std::uint32_t image_ = kSize;
};

}  // namespace vins::feature_tracker
