#include "vins_estimator/health/stillness.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "vins_core/option_check.h"
#include "vins_core/time.h"

namespace vins::estimator {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

/// Sum, sum of squares and number of vectors.
class Moments {
 public:
  void add(const Vector3d& value) {
    // Relative to the first, so that gravity takes no digits from the deviation.
    if (count_ == 0) origin_ = value;
    const Array3d difference = (value - origin_).array();
    sum_ += difference;
    squares_ += difference.square();
    ++count_;
  }
  int count() const { return count_; }
  Vector3d mean() const { return origin_ + (sum_ / std::max(count_, 1)).matrix(); }
  /// Of the axis that varies most; 0 for less than two.
  double deviation() const {
    if (count_ < 2) return 0.0;
    const Array3d variance = (squares_ - sum_.square() / count_) / (count_ - 1);
    return std::sqrt(std::max(0.0, variance.maxCoeff()));
  }

 private:
  int count_ = 0;
  Vector3d origin_ = Vector3d::Zero();
  Array3d sum_ = Array3d::Zero();
  Array3d squares_ = Array3d::Zero();
};

/// Moments of the means over blocks of a channel.
class BlockMoments {
 public:
  void add(const Vector3d& value) { block_.add(value); }
  void endBlock() {
    if (block_.count() > 0) means_.add(block_.mean());
    block_ = Moments();
  }
  const Moments& means() const { return means_; }

 private:
  Moments block_, means_;
};

bool isStill(const ImuStillness& figures, const StillnessOptions& options) {
  return figures.acceleration <= options.max_acceleration &&
         figures.angular_velocity <= options.max_angular_velocity &&
         figures.vibration <= options.max_vibration &&
         figures.mean_angular_velocity.norm() <= options.max_turn_rate &&
         std::abs(figures.mean_acceleration.norm() - options.gravity) <= options.max_gravity_error;
}

/// A track's mean direction in four groups of frames: [half][parity].
struct TrackMeans {
  Vector3d sum[2][2] = {{Vector3d::Zero(), Vector3d::Zero()}, {Vector3d::Zero(), Vector3d::Zero()}};
  int frames = 0;
  double angular_resolution = 0.0;

  /// From the first half to the second, by the frames of one parity [px].
  Vector3d motion(int parity) const {
    return (sum[1][parity].normalized() - sum[0][parity].normalized()) / angular_resolution;
  }
};

std::map<std::int64_t, TrackMeans> collectMeans(const std::vector<const FeatureFrame*>& frames) {
  std::map<std::int64_t, TrackMeans> tracks;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const int half = 2 * i < frames.size() ? 0 : 1;
    for (const FeatureObservation& observation : frames[i]->observations) {
      if (observation.camera != 0) continue;
      TrackMeans& track = tracks[observation.id];
      track.sum[half][i % 2] += observation.bearing;
      track.angular_resolution = observation.angular_resolution;
      ++track.frames;
    }
  }
  return tracks;
}

double median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace

void StillnessOptions::validate() const {
  requirePositive("stillness", "window", window);
  requirePositive("stillness", "block", block);
  requirePositive("stillness", "max_acceleration", max_acceleration);
  requirePositive("stillness", "max_angular_velocity", max_angular_velocity);
  requirePositive("stillness", "max_vibration", max_vibration);
  requirePositive("stillness", "max_turn_rate", max_turn_rate);
  requirePositive("stillness", "max_gravity_error", max_gravity_error);
  requirePositive("stillness", "gravity", gravity);
  requirePositive("stillness", "max_image_motion", max_image_motion);
  requirePositive("stillness", "min_features", min_features);
  if (min_frames < 4) {
    refuseOption("stillness", "min_frames", min_frames, "at least 4");
  }
}

ImuStillness judgeImu(const std::vector<ImuSample>& samples, const StillnessOptions& options) {
  constexpr int kMinBlocks = 3;
  ImuStillness figures;
  if (samples.empty()) return figures;
  Moments acceleration, angular_velocity;
  BlockMoments acceleration_blocks, angular_velocity_blocks;
  Stamp block_end = samples.front().stamp + toNanoseconds(options.block);
  for (const ImuSample& sample : samples) {
    if (sample.stamp >= block_end) {
      acceleration_blocks.endBlock();
      angular_velocity_blocks.endBlock();
      block_end += toNanoseconds(options.block);
    }
    acceleration.add(sample.acceleration);
    angular_velocity.add(sample.angular_velocity);
    acceleration_blocks.add(sample.acceleration);
    angular_velocity_blocks.add(sample.angular_velocity);
  }
  // The block that has just begun is left out: the mean of a few samples keeps the vibration.
  figures.acceleration = acceleration_blocks.means().deviation();
  figures.angular_velocity = angular_velocity_blocks.means().deviation();
  figures.vibration = acceleration.deviation();
  figures.mean_acceleration = acceleration.mean();
  figures.mean_angular_velocity = angular_velocity.mean();
  figures.still = acceleration_blocks.means().count() >= kMinBlocks && isStill(figures, options);
  return figures;
}

ImageStillness judgeImages(const std::vector<const FeatureFrame*>& frames,
                           const StillnessOptions& options) {
  ImageStillness figures;
  std::vector<double> products;
  for (const auto& [id, track] : collectMeans(frames)) {
    if (track.frames != static_cast<int>(frames.size())) continue;
    products.push_back(track.motion(0).dot(track.motion(1)));
  }
  figures.features = static_cast<int>(products.size());
  if (figures.features < options.min_features ||
      static_cast<int>(frames.size()) < options.min_frames) {
    return figures;
  }
  figures.motion = std::sqrt(std::max(0.0, median(&products)));
  figures.still = figures.motion <= options.max_image_motion;
  return figures;
}

StillnessDetector::StillnessDetector(const StillnessOptions& options) : options_(options) {
  options_.validate();
}

bool StillnessDetector::addFrame(SharedMeasurements measurements) {
  const Stamp oldest = measurements->frame.stamp - toNanoseconds(options_.window);
  entries_.push_back(std::move(measurements));
  // The frame at the window's begin stays, or the one before it.
  while (entries_.size() > 1 && entries_[1]->frame.stamp <= oldest) entries_.pop_front();
  still_ = false;
  imu_ = ImuStillness();
  images_ = ImageStillness();
  if (!spansWindow()) return false;

  std::vector<ImuSample> samples;
  std::vector<const FeatureFrame*> frames;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    frames.push_back(&entries_[i]->frame);
    // The first frame's samples lie before the window.
    const std::vector<ImuSample>& imu = entries_[i]->imu;
    if (i > 0) samples.insert(samples.end(), imu.begin(), imu.end());
  }
  imu_ = judgeImu(samples, options_);
  images_ = judgeImages(frames, options_);
  still_ = imu_.still && images_.still;
  return still_;
}

bool StillnessDetector::spansWindow() const {
  // Camera periods jitter by some microseconds.
  constexpr double kJitter = 0.01;
  const Stamp span = entries_.back()->frame.stamp - entries_.front()->frame.stamp;
  return toSeconds(span) >= options_.window - kJitter;
}

void StillnessDetector::clear() {
  entries_.clear();
  imu_ = ImuStillness();
  images_ = ImageStillness();
  still_ = false;
}

}  // namespace vins::estimator
