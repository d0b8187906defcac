#include "vins_estimator/initialization/retiming.h"

#include <algorithm>
#include <memory>

#include "vins_core/time.h"

namespace vins::estimator {
namespace {

bool isBefore(const ImuSample& sample, Stamp stamp) { return sample.stamp < stamp; }

/// All samples once, stamps rising.
std::vector<ImuSample> samplesOf(const std::deque<SharedMeasurements>& frames) {
  std::vector<ImuSample> samples;
  for (const SharedMeasurements& measurements : frames) {
    for (const ImuSample& sample : measurements->imu) {
      if (samples.empty() || sample.stamp > samples.back().stamp) samples.push_back(sample);
    }
  }
  return samples;
}

/// `stamp` lies within the samples.
ImuSample sampleAt(const std::vector<ImuSample>& samples, Stamp stamp) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), stamp, isBefore);
  if (after->stamp == stamp || after == samples.begin()) return *after;
  return interpolate(*std::prev(after), *after, stamp);
}

/// From exactly `begin` to exactly `end`.
std::vector<ImuSample> cutOut(const std::vector<ImuSample>& samples, Stamp begin, Stamp end) {
  std::vector<ImuSample> cut = {sampleAt(samples, begin)};
  auto sample = std::lower_bound(samples.begin(), samples.end(), begin + 1, isBefore);
  for (; sample != samples.end() && sample->stamp < end; ++sample) cut.push_back(*sample);
  if (end > begin) cut.push_back(sampleAt(samples, end));
  return cut;
}

}  // namespace

RetimedFrames retime(const std::deque<SharedMeasurements>& frames, double shift) {
  RetimedFrames result;
  const std::vector<ImuSample> samples = samplesOf(frames);
  if (samples.empty()) return result;
  Stamp begin = samples.front().stamp;
  for (const SharedMeasurements& measurements : frames) {
    const Stamp end = measurements->end + toNanoseconds(shift);
    if (end < begin) continue;
    if (end > samples.back().stamp) break;
    FrameMeasurements retimed = *measurements;
    retimed.begin = begin;
    retimed.end = end;
    retimed.imu = cutOut(samples, begin, end);
    result.frames.push_back(std::make_shared<const FrameMeasurements>(std::move(retimed)));
    begin = end;
  }
  result.rest = cutOut(samples, begin, samples.back().stamp);
  return result;
}

}  // namespace vins::estimator
