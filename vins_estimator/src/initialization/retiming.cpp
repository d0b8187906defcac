#include "vins_estimator/initialization/retiming.h"

#include <memory>
#include <utility>

#include "vins_core/time.h"

namespace vins::estimator {
namespace {

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

}  // namespace

RetimedFrames retime(const std::deque<SharedMeasurements>& frames, double shift) {
  RetimedFrames result;
  if (frames.empty()) return result;
  result.samples = samplesOf(frames);
  MeasurementQueue queue;
  for (const ImuSample& sample : result.samples) queue.addImu(sample);
  for (const SharedMeasurements& measurements : frames) queue.addFrame(measurements->frame);
  const FrameMeasurements& newest = *frames.back();
  const double td = toSeconds(newest.end - newest.frame.stamp) + shift;
  while (auto retimed = queue.next(td)) {
    result.frames.push_back(std::make_shared<const FrameMeasurements>(*std::move(retimed)));
  }
  return result;
}

}  // namespace vins::estimator
