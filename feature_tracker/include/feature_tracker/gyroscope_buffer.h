#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "vins_core/imu.h"
#include "vins_core/time.h"

namespace vins::feature_tracker {

/// Holds IMU samples until the image that they lead to is tracked, and puts them on the camera's
/// clock: t_imu = t_cam + td. Live nodes and recordings use the same buffer, so that an image gets
/// the same samples however they arrive. Not thread-safe.
class GyroscopeBuffer {
 public:
  /// `td`: time offset of the camera, t_imu = t_cam + td [s].
  explicit GyroscopeBuffer(double td) : offset_(toNanoseconds(td)) {}

  /// Appends a sample of the IMU's clock. A stamp that falls by more than a second begins a new
  /// recording: the samples before it are dropped. Beyond ten thousand samples the oldest go.
  void add(const ImuSample& sample);

  /// Returns whether the samples up to an image's stamp (of the camera's clock) have come.
  bool reaches(Stamp image) const { return newest_ && *newest_ >= image + offset_; }

  /// Removes and returns the samples up to an image's stamp, stamped by the camera's clock.
  std::vector<ImuSample> takeUntil(Stamp image);

 private:
  Stamp offset_;  ///< td [ns]
  std::deque<ImuSample> samples_;
  std::optional<Stamp> newest_;  ///< of the sample that came last [ns, the IMU's clock]
};

}  // namespace vins::feature_tracker
