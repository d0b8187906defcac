#include "input_queue.h"

#include <cstdlib>
#include <utility>

namespace vins::feature_tracker {
namespace {

constexpr std::size_t kMostImages = 10;
constexpr std::size_t kMostSamples = 4000;
constexpr Stamp kSameTime = 3'000'000;  // between the images of a stereo pair [ns]
constexpr std::chrono::milliseconds kPatience(50);
constexpr std::chrono::milliseconds kPoll(5);

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
  // After a jump back the samples from before it are of no use.
  if (!samples_.empty() && sample.stamp < samples_.back().stamp) samples_.clear();
  samples_.push_back(sample);
  if (samples_.size() > kMostSamples) samples_.pop_front();
  changed_.notify_one();
}

bool InputQueue::partnerIsDecided(const QueuedImage& image) const {
  if (!stereo_) return true;
  for (const QueuedImage& other : images_[1]) {
    if (other.stamp >= image.stamp - kSameTime) return true;
  }
  return false;
}

bool InputQueue::isReady() const {
  if (images_[0].empty()) return false;
  const QueuedImage& image = images_[0].front();
  const bool imu_is_there =
      !imu_expected_ || (!samples_.empty() && samples_.back().stamp >= image.stamp);
  if (imu_is_there && partnerIsDecided(image)) return true;
  return std::chrono::steady_clock::now() - image.arrival > kPatience;
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
  while (!samples_.empty() && samples_.front().stamp <= stamp) {
    input.imu.push_back(samples_.front());
    samples_.pop_front();
  }
  return input;
}

std::optional<TrackerInput> InputQueue::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!is_closed_ && !isReady()) changed_.wait_for(lock, kPoll);
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
