#pragma once

#include <optional>

#include "vins_core/event.h"
#include "vins_core/time.h"

namespace vins::estimator {

/// Tells when the images no longer carry the estimate (a blackout, blur, a covered lens), and when
/// they do again: events `tracking_lost` and `tracking_resumed`.
class TrackWatch {
 public:
  /// `min_tracks`: fewer in an image are lost.
  explicit TrackWatch(int min_tracks) : min_tracks_(min_tracks) {}

  /// Takes the number of tracks in the image at `stamp`; an event where that changes the verdict.
  std::optional<Event> addFrame(Stamp stamp, int tracks);

  bool isLost() const { return lost_since_.has_value(); }
  void clear() { lost_since_.reset(); }

 private:
  int min_tracks_;
  std::optional<Stamp> lost_since_;
};

}  // namespace vins::estimator
