#include "feature_tracker/gyroscope_buffer.h"

namespace vins::feature_tracker {
namespace {

constexpr Stamp kJump = 1'000'000'000;  // stamps that fall by more begin a new recording [ns]
constexpr std::size_t kMaxSamples = 10000;

}  // namespace

void GyroscopeBuffer::add(const ImuSample& sample) {
  if (newest_ && sample.stamp < *newest_ - kJump) samples_.clear();
  samples_.push_back(sample);
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  newest_ = sample.stamp;
}

std::vector<ImuSample> GyroscopeBuffer::takeUntil(Stamp image) {
  std::vector<ImuSample> samples;
  while (!samples_.empty() && samples_.front().stamp - offset_ <= image) {
    samples.push_back(samples_.front());
    samples.back().stamp -= offset_;
    samples_.pop_front();
  }
  return samples;
}

}  // namespace vins::feature_tracker
