#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "vins_core/event.h"
#include "vins_core/imu.h"
#include "vins_core/time.h"

namespace vins::estimator {

/// Options of ImuPlausibility.
struct ImuPlausibilityOptions {
  double gravity = 9.81;          ///< g_norm [m/s^2]
  double window = 2.0;            ///< samples judged together [s]
  double max_rate = 35.0;         ///< of consumer gyroscopes: 2000 degrees per second [rad/s]
  double max_mean_rate = 6.5;     ///< over a window: more than a turn per second [rad/s]
  double max_clock_offset = 5.0;  ///< between the newest image and IMU sample [s]
  double event_interval = 10.0;   ///< before the same finding is reported again [s]
  std::optional<Eigen::Quaterniond> R_bc;  ///< camera to body, where it is known
};

/// Detects inertial data that cannot be what it claims: wrong units, a silent or constant sensor,
/// no gravity, gravity upside down, clocks of camera and IMU apart. Memory is bounded. Events:
/// imu_accelerometer_units, imu_no_gravity, imu_accelerometer_silent, imu_gyroscope_silent,
/// imu_gyroscope_units, imu_upside_down, clocks_apart.
class ImuPlausibility {
 public:
  explicit ImuPlausibility(const ImuPlausibilityOptions& options) : options_(options) {}

  /// Takes samples as they come, also those with bad stamps. Ignores values that are not finite.
  void addImu(const ImuSample& sample);

  /// Takes the stamp of an image as it comes [ns].
  void addImage(Stamp stamp);

  std::vector<Event> takeEvents() { return std::exchange(events_, {}); }

 private:
  /// Sums over the samples of a window.
  struct Window {
    int count = 0;
    ImuSample first;
    Eigen::Vector3d acceleration_sum = Eigen::Vector3d::Zero();
    double acceleration_norm_sum = 0.0, rate_sum = 0.0, rate_max = 0.0;
    bool acceleration_is_constant = true, rate_is_constant = true;

    void add(const ImuSample& sample);
  };

  void judgeAccelerometer(Stamp now);
  void judgeGyroscope(Stamp now);
  void judgeClocks();
  void report(Stamp now, const char* code, std::string text,
              std::vector<std::pair<std::string, double>> figures);

  ImuPlausibilityOptions options_;
  Window window_;
  std::optional<Stamp> newest_imu_, newest_image_;
  int images_apart_ = 0, samples_apart_ = 0;  ///< without a pair of close stamps
  std::map<std::string, Stamp> reported_;     ///< by code
  std::vector<Event> events_;
};

}  // namespace vins::estimator
