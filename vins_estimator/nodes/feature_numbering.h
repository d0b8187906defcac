#pragma once

#include <cstdint>
#include <optional>

#include "vins_core/continued_ids.h"
#include "vins_core/feature_frame.h"

namespace vins::estimator {

/// Frames of a tracker that may have been started again: it counts tracks from 0 anew, and the
/// window would take them for the landmarks that had those ids.
class FeatureNumbering {
 public:
  /// Numbers a frame's tracks as the estimator shall know them. True where the tracker has been
  /// started again: its frames' count has fallen.
  bool take(FeatureFrame* frame);

 private:
  std::optional<std::uint32_t> last_sequence_;
  ContinuedIds ids_;
};

}  // namespace vins::estimator
