#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vins_core/event.h"
#include "vins_core/imu.h"
#include "vins_core/time.h"

namespace vins {

/// Options of ImuJoiner.
struct ImuJoinerOptions {
  double max_interval = 0.1;     ///< between accelerometer samples that are interpolated [s]
  double silence = 1.0;          ///< without one sensor, before that is told [s]
  double max_jump = 1.0;         ///< a stamp further back is a restarted recording [s]
  double event_interval = 10.0;  ///< before the same event is given again [s]

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// Joins a gyroscope and an accelerometer that come apart, each at a rate of its own: at every
/// stamp of the gyroscope the acceleration is interpolated linearly between its two neighbours.
/// Nothing is extrapolated: a gyroscope sample waits for the acceleration behind it, and is left
/// out before the first one and within an interval above `max_interval`. Samples that are not
/// finite, double or out of order are left out. Memory is bounded. Events: imu_disorder,
/// imu_accelerometer_missing, imu_gyroscope_missing.
class ImuJoiner {
 public:
  explicit ImuJoiner(const ImuJoinerOptions& options = {});

  void addGyroscope(Stamp stamp, const Eigen::Vector3d& angular_velocity);  ///< [ns], [rad/s]
  void addAccelerometer(Stamp stamp, const Eigen::Vector3d& acceleration);  ///< [ns], [m/s^2]

  /// The next joined sample, or nothing until its acceleration can be told. Call until it returns
  /// nothing.
  std::optional<ImuSample> next();

  /// What has happened since the last call.
  std::vector<Event> takeEvents() { return std::exchange(events_, {}); }

  /// Samples that are kept, of both sensors.
  std::size_t sampleCount() const { return gyroscope_.size() + accelerometer_.size(); }

 private:
  struct Reading {
    Stamp stamp = 0;  ///< [ns]
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
  };
  using Readings = std::deque<Reading>;

  void add(const Reading& reading, Readings* readings, std::optional<Stamp>* newest);
  bool accept(const Reading& reading, std::optional<Stamp>* newest);
  void jumpBack(Stamp to);
  void reportSilence();
  void reportDisorder(Stamp now);
  bool isDue(Stamp now, std::optional<Stamp>* reported) const;
  void report(Stamp now, const char* code, std::string text,
              std::vector<std::pair<std::string, double>> figures);
  std::optional<Eigen::Vector3d> accelerationAt(Stamp stamp) const;

  ImuJoinerOptions options_;
  Readings gyroscope_;      ///< not yet joined
  Readings accelerometer_;  ///< from the last one not after the last joined sample
  std::optional<Stamp> newest_gyroscope_, newest_accelerometer_;
  std::optional<Stamp> first_stamp_;  ///< of either sensor, since the start or a jump
  int not_finite_ = 0, out_of_order_ = 0;
  std::optional<Stamp> disorder_reported_, accelerometer_reported_, gyroscope_reported_;
  std::vector<Event> events_;
};

}  // namespace vins
