#include "feature_tracker/frame_clock.h"

namespace vins::feature_tracker {
namespace {

constexpr double kJump = 1.0;  // backwards by more is a recording that begins again [s]

}  // namespace

StampVerdict FrameClock::judge(Stamp stamp) const {
  // Negative stamps are refused before anything is subtracted: no difference can overflow.
  if (stamp < 0) return StampVerdict::kNegative;
  if (!last_) return StampVerdict::kFirst;
  if (stamp == *last_) return StampVerdict::kDuplicate;
  if (stamp < *last_) {
    const bool is_late = toSeconds(*last_ - stamp) < kJump;
    return is_late ? StampVerdict::kLate : StampVerdict::kBackwards;
  }
  return toSeconds(stamp - *last_) > max_gap_ ? StampVerdict::kGap : StampVerdict::kNext;
}

bool FrameClock::advance(Stamp stamp) {
  const Stamp half_interval = last_ ? (stamp - *last_) / 2 : 0;
  const bool is_first = !last_;
  last_ = stamp;
  if (frequency_ <= 0.0) return true;
  const Stamp period = toNanoseconds(1.0 / frequency_);
  if (is_first) next_due_ = stamp;
  // The image nearest to the due time is taken, be it a little early.
  if (next_due_ - stamp > half_interval) return false;
  next_due_ += period;
  // After dropped images the beat starts anew: no burst to catch up.
  if (next_due_ < stamp) next_due_ = stamp + period;
  return true;
}

void FrameClock::reset() { last_.reset(); }

}  // namespace vins::feature_tracker
