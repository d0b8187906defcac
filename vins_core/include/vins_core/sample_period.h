#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "vins_core/time.h"

namespace vins {

/// The period of a sensor: the median of the last intervals between its stamps, so that gaps,
/// jitter and single interpolated samples do not matter.
class SamplePeriod {
 public:
  /// The stamp [ns] of the next sample. One that does not rise begins a new series.
  void add(Stamp stamp) {
    if (last_ && stamp > *last_) intervals_[count_++ % kIntervals] = toSeconds(stamp - *last_);
    last_ = stamp;
  }

  /// [s]; nullopt before the second sample.
  std::optional<double> seconds() const {
    if (count_ == 0) return std::nullopt;
    std::array<double, kIntervals> sorted = intervals_;
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kIntervals));
    const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
    std::nth_element(sorted.begin(), middle, end);
    return *middle;
  }

 private:
  static constexpr std::size_t kIntervals = 15;
  std::optional<Stamp> last_;
  std::array<double, kIntervals> intervals_{};  ///< [s], a ring
  std::size_t count_ = 0;                       ///< intervals so far
};

}  // namespace vins
