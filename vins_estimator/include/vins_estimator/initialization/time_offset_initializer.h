#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "vins_core/event.h"
#include "vins_core/time.h"
#include "vins_estimator/initialization/time_offset_search.h"

namespace vins::estimator {

/// Searches the time offset once, before the first states, and says how long a moving start waits
/// for it: with a wrong time offset it would be a wrong start.
class TimeOffsetInitializer {
 public:
  /// `enabled`: false where the time offset is not to be estimated; nothing is searched then.
  explicit TimeOffsetInitializer(bool enabled) : enabled_(enabled) {}

  /// Returns whether a moving start at `now` has to wait: for some seconds after the first call,
  /// since the search needs a turn.
  bool awaits(Stamp now);

  /// Takes the next frame; returns the offset when it is found, once. Its deviation allows for
  /// turns that parallax bends. `R_bc`: camera in the body.
  std::optional<TimeOffset> addFrame(const FrameMeasurements& measurements,
                                     const Eigen::Quaterniond& R_bc);

  /// Searches anew.
  void clear();

 private:
  bool enabled_;
  bool found_ = false;
  std::optional<Stamp> begin_;  ///< of the first frame that it could look at
  TimeOffsetSearch search_;
};

/// The event `time_offset_found`.
Event toEvent(Stamp stamp, const TimeOffset& found);

}  // namespace vins::estimator
