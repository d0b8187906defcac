#include "input_queue.h"

#include <cstdlib>
#include <utility>

namespace vins::feature_tracker {
namespace {

constexpr std::size_t kMostImages = 30;
constexpr Stamp kSameTime = 3'000'000;  // between the images of a stereo pair [ns]
constexpr std::chrono::milliseconds kPartnerPatience(50);
constexpr std::chrono::milliseconds kImuPatience(1000);

}  // namespace

void InputQueue::addImage(int camera, QueuedImage image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::deque<QueuedImage>& queue = images_[camera];
  queue.push_back(std::move(image));
  if (queue.size() > kMostImages) {
    queue.pop_front();
    if (camera == 0) ++dropped_;
  }
  changed_.notify_one();
}

void InputQueue::addImu(const ImuSample& sample) {
  const std::lock_guard<std::mutex> lock(mutex_);
  gyroscope_.add(sample);
  imu_is_silent_ = false;
  changed_.notify_one();
}

bool InputQueue::partnerIsDecided(const QueuedImage& image) const {
  if (!stereo_) return true;
  for (const QueuedImage& other : images_[1]) {
    if (other.stamp >= image.stamp - kSameTime) return true;
  }
  return false;
}

bool InputQueue::imuIsThere(const QueuedImage& image) const {
  return !imu_expected_ || imu_is_silent_ || gyroscope_.reaches(image.stamp);
}

/// Waits until the oldest image has what it needs, or for as long as it is worth.
void InputQueue::waitForFront(std::unique_lock<std::mutex>* lock) {
  const Clock::time_point arrival = images_[0].front().arrival;
  const auto wait = [&](std::chrono::milliseconds patience, auto is_there) {
    return changed_.wait_until(*lock, arrival + patience, [&] {
      return is_closed_ || images_[0].empty() || is_there(images_[0].front());
    });
  };
  imu_is_silent_ =
      !wait(kImuPatience, [this](const QueuedImage& image) { return imuIsThere(image); }) ||
      imu_is_silent_;
  wait(kPartnerPatience, [this](const QueuedImage& image) { return partnerIsDecided(image); });
}

TrackerInput InputQueue::takeFront() {
  TrackerInput input;
  input.first = std::move(images_[0].front());
  images_[0].pop_front();
  const Stamp stamp = input.first.stamp;
  std::deque<QueuedImage>& others = images_[1];
  while (!others.empty() && others.front().stamp < stamp - kSameTime) others.pop_front();
  if (!others.empty() && std::abs(others.front().stamp - stamp) <= kSameTime) {
    input.second = std::move(others.front());
    others.pop_front();
  }
  input.imu = gyroscope_.takeUntil(stamp);
  return input;
}

std::optional<TrackerInput> InputQueue::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return is_closed_ || !images_[0].empty(); });
  if (!is_closed_) waitForFront(&lock);
  if (is_closed_) return std::nullopt;
  return takeFront();
}

void InputQueue::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_closed_ = true;
  changed_.notify_one();
}

int InputQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

}  // namespace vins::feature_tracker
