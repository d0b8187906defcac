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
/// An image waits a little for its partner of the other camera and for the IMU samples up to it.
class InputQueue {
 public:
  InputQueue(bool stereo, bool imu) : stereo_(stereo), imu_expected_(imu) {}

  void addImage(int camera, QueuedImage image);
  void addImu(const ImuSample& sample);

  /// Waits for the next input; nothing after close().
  std::optional<TrackerInput> take();
  void close();

  /// Images dropped so far, because the worker was too slow.
  int dropped() const;

 private:
  bool isReady() const;
  bool partnerIsDecided(const QueuedImage& image) const;
  TrackerInput takeFront();

  bool stereo_, imu_expected_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<QueuedImage> images_[2];
  std::deque<ImuSample> samples_;
  int dropped_ = 0;
  bool is_closed_ = false;
};

}  // namespace vins::feature_tracker
