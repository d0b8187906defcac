#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vins_core/event.h"
#include "vins_core/time.h"
#include "vins_pipeline/recording.h"

namespace vins::pipeline {

/// What a run has used of its recording: refused images, the ends of the streams, and why the
/// estimator has waited.
class InputAccount {
 public:
  void addImu(Stamp stamp);
  void addAcceleration(Stamp stamp);  ///< of an accelerometer with a topic of its own
  void addImage(Stamp stamp);

  /// An image that cannot be used, and why: an event `image_refused`. Throws InputError with
  /// `reason` where the first ten images have all been refused.
  Event refuse(Stamp stamp, const std::string& reason);

  /// Keeps the last event of each reason to wait (`init_*`) and of each finding about the inputs
  /// (`imu_*`, `clocks_apart`), and what the estimator finds wrong of the rig (`rig_*`) until it
  /// takes that back (`rig_agrees`).
  void addEvents(const std::vector<Event>& events);

  std::size_t refused() const { return refused_; }

  /// Throws InputError with the first reason where every image has been refused.
  void requireImages() const;

  /// When the IMU, or a part of it with a topic of its own, ended, where images of its time go on
  /// for more than half a second behind that [ns].
  std::optional<Stamp> imuEnd() const;

  /// Lines for a summary: damage, refused images, an IMU that ended early, a wrong rig; empty where
  /// all is well.
  std::string problems(const RecordingSummary& recording) const;

  /// A line for each kind of reason that was given while waiting.
  std::string waitingReasons() const;

 private:
  std::size_t accepted_ = 0;
  std::size_t refused_ = 0;
  std::string first_reason_;
  std::optional<Stamp> last_imu_, last_acceleration_, first_image_, last_image_;
  std::map<std::string, std::string> reasons_;  ///< by the event's code
  std::string rig_finding_;
};

}  // namespace vins::pipeline
