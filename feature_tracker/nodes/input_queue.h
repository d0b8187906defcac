#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include <boost/shared_ptr.hpp>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include "feature_tracker/gyroscope_buffer.h"
#include "vins_core/imu.h"
#include "vins_core/time.h"

namespace vins::feature_tracker {

/// An image as it came; one of the two messages is set.
struct QueuedImage {
  Stamp stamp = 0;  ///< [ns]
  sensor_msgs::ImageConstPtr raw;
  sensor_msgs::CompressedImageConstPtr compressed;
  std::chrono::steady_clock::time_point arrival = std::chrono::steady_clock::now();
};

/// What the tracker needs for one step.
struct TrackerInput {
  QueuedImage first;
  std::optional<QueuedImage> second;
  std::vector<ImuSample> imu;
};

/// Between the callbacks, which only put messages here, and the worker that takes them: bounded.
/// An image waits a little for its partner of the other camera, and for the IMU samples up to it as
/// long as an IMU seems to be there: what the tracker gets does not depend on when messages come.
class InputQueue {
 public:
  /// `td`: time offset of the camera, t_imu = t_cam + td [s].
  InputQueue(bool stereo, bool imu, double td)
      : stereo_(stereo), imu_expected_(imu), gyroscope_(td) {}

  void addImage(int camera, QueuedImage image);
  void addImu(const ImuSample& sample);

  /// Waits for the next input; nothing after close().
  std::optional<TrackerInput> take();
  void close();

  /// Images dropped so far, because the worker was too slow.
  int dropped() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool imuIsThere(const QueuedImage& image) const;
  bool partnerIsDecided(const QueuedImage& image) const;
  void waitForFront(std::unique_lock<std::mutex>* lock);
  TrackerInput takeFront();

  bool stereo_, imu_expected_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<QueuedImage> images_[2];
  GyroscopeBuffer gyroscope_;
  bool imu_is_silent_ = false;  ///< an image has waited for it in vain
  int dropped_ = 0;
  bool is_closed_ = false;
};

}  // namespace vins::feature_tracker
