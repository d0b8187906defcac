#pragma once

#include <optional>

#include "vins_core/time.h"

namespace vins::feature_tracker {

/// What a stamp means for the image that bears it.
enum class StampVerdict {
  kFirst,      ///< nothing came before
  kNext,       ///< follows the image before
  kDuplicate,  ///< of the image before: refuse it
  kLate,       ///< earlier than the image before by less than a second: refuse it
  kNegative,   ///< no time at all: refuse it
  kBackwards,  ///< earlier by more, as when a recording begins again: start again
  kGap         ///< after a pause that no track survives: new tracks
};

/// Watches the stamps of images, and knows which of them are due at a lower rate.
class FrameClock {
 public:
  /// `max_gap` [s] is the longest pause; `frequency` [Hz] the rate of due images, 0 for all.
  FrameClock(double max_gap, double frequency) : max_gap_(max_gap), frequency_(frequency) {}

  /// Judges a stamp without taking it.
  StampVerdict judge(Stamp stamp) const;

  /// Takes an image of this stamp as the latest one; true where it is due.
  bool advance(Stamp stamp);

  /// Stamp of the latest image.
  std::optional<Stamp> last() const { return last_; }

  void reset();

 private:
  double max_gap_;
  double frequency_;
  std::optional<Stamp> last_;
  Stamp next_due_ = 0;
};

}  // namespace vins::feature_tracker
