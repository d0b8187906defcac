#include "vins_pipeline/stamp_order.h"

#include <algorithm>

namespace vins::pipeline {
namespace {

constexpr Stamp kJump = 1'000'000'000;  ///< stamps that fall by more begin a new run [ns]

}  // namespace

void StampOrder::Span::add(Stamp stamp) {
  falls = falls || (!is_empty && stamp < last - kJump);
  first = is_empty ? stamp : std::min(first, stamp);
  last = is_empty ? stamp : std::max(last, stamp);
  is_empty = false;
}

void StampOrder::add(Stream stream, Stamp stamp) {
  if (stream == Stream::kImu) imu_.add(stamp);
  if (stream == Stream::kImage) images_.add(stamp);
  place_.push_back(stamps_.size());
  stamps_.push_back(stamp);
}

bool StampOrder::areComparable() const {
  if (imu_.falls || images_.falls || imu_.is_empty || images_.is_empty) return false;
  return imu_.first <= images_.last && images_.first <= imu_.last;
}

void StampOrder::sort() {
  if (!areComparable()) return;
  std::stable_sort(place_.begin(), place_.end(),
                   [this](std::size_t a, std::size_t b) { return stamps_[a] < stamps_[b]; });
}

}  // namespace vins::pipeline
