#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_estimator/inertial/measurement_queue.h"

namespace vins::estimator {

/// Thresholds of StillnessDetector. The inertial ones hold for means over blocks of 0.1 s: idling
/// motors shake an IMU by 1 m/s^2 (EuRoC MH_01), of which the means keep a tenth.
struct StillnessOptions {
  double window = 0.5;                 ///< the time that is judged [s]
  double block = 0.1;                  ///< over which samples are averaged [s]
  double max_acceleration = 0.25;      ///< deviation of the blocks' means, per axis [m/s^2]
  double max_angular_velocity = 0.02;  ///< the same of the gyroscope [rad/s]
  double max_vibration = 3.0;          ///< deviation of single samples [m/s^2]
  double max_turn_rate = 0.3;          ///< length of the mean, bias included [rad/s]
  double max_gravity_error = 0.8;      ///< of the mean's length, bias included [m/s^2]
  double gravity = 9.81;               ///< [m/s^2]
  double max_image_motion = 0.5;       ///< over half of the window, free of noise [px]
  int min_features = 15;               ///< seen throughout the window
  int min_frames = 6;                  ///< in the window

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// Figures of the IMU over a window.
struct ImuStillness {
  bool still = false;
  double acceleration = 0.0;      ///< deviation of the blocks' means, largest axis [m/s^2]
  double angular_velocity = 0.0;  ///< the same of the gyroscope [rad/s]
  double vibration = 0.0;         ///< deviation of single samples, largest axis [m/s^2]
  Eigen::Vector3d mean_acceleration = Eigen::Vector3d::Zero();      ///< [m/s^2]
  Eigen::Vector3d mean_angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// Figures of the images over a window.
struct ImageStillness {
  bool still = false;
  int features = 0;     ///< seen throughout
  double motion = 0.0;  ///< median, free of noise, from the window's first half to its second [px]
};

/// Judges samples that span a window. Alone it cannot tell rest from a smooth cruise.
ImuStillness judgeImu(const std::vector<ImuSample>& samples, const StillnessOptions& options);

/// Judges frames that span a window. A track's motion is measured twice, by its even and its odd
/// frames, whose noise is independent: the median of the products over the tracks is free of noise,
/// and of moving objects as long as they are the minority.
ImageStillness judgeImages(const std::vector<const FeatureFrame*>& frames,
                           const StillnessOptions& options);

/// Tells whether the sensors stand still, which IMU and images must both say: a cruise at constant
/// speed looks like rest to the IMU, a blank image tells nothing.
class StillnessDetector {
 public:
  /// Throws InputError for options that are out of range.
  explicit StillnessDetector(const StillnessOptions& options);

  /// Takes a frame with the samples since the frame before, which it keeps for as long as it needs
  /// them; true if the last `window` seconds were still.
  bool addFrame(SharedMeasurements measurements);

  /// Of the last addFrame().
  bool isStill() const { return still_; }
  const ImuStillness& imu() const { return imu_; }
  const ImageStillness& images() const { return images_; }

  void clear();

 private:
  bool spansWindow() const;

  StillnessOptions options_;
  std::deque<SharedMeasurements> entries_;  ///< oldest first
  ImuStillness imu_;
  ImageStillness images_;
  bool still_ = false;
};

}  // namespace vins::estimator
