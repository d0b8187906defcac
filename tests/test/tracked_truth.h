#pragma once

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "feature_tracker/feature_tracker.h"
#include "simulation/recording_simulator.h"

namespace vins::simulation {

/// How the tracks of a simulated recording fared against the truth: the point of the still scene
/// that a track's first pixel sees. A track that begins on a moving object is wrong as soon as the
/// object has moved.
struct TrackedTruth {
  int images = 0;
  int observations = 0;         ///< of tracks seen before
  int gross_outliers = 0;       ///< of them, more than 5 px from the truth
  int aged = 0;                 ///< tracks handed on 10 images after their first one
  int aged_within_a_pixel = 0;  ///< of them, within 1 px of the truth then
  std::vector<int> lifetimes;   ///< images, of the tracks that ended
  std::vector<int> ages;        ///< track_length of every observation handed on, once settled
  double features = 0.0;        ///< mean per image
  double inlier_ratio = 0.0;    ///< mean per image

  double grossShare() const { return static_cast<double>(gross_outliers) / observations; }
  double alignedShare() const { return static_cast<double>(aged_within_a_pixel) / aged; }
};

inline int medianOf(std::vector<int> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

inline std::ostream& operator<<(std::ostream& out, const TrackedTruth& truth) {
  return out << truth.images << " images, " << truth.features << " features per image; "
             << 100.0 * truth.alignedShare() << " % of " << truth.aged
             << " tracks within 1 px after 10 images; " << 100.0 * truth.grossShare() << " % of "
             << truth.observations << " observations gross; median lifetime "
             << medianOf(truth.lifetimes) << " of " << truth.lifetimes.size()
             << " ended tracks, median age " << medianOf(truth.ages) << " images; inlier ratio "
             << truth.inlier_ratio;
}

/// Follows what the tracker hands on, image by image.
class TruthKeeper {
 public:
  explicit TruthKeeper(const SimulatedRecording& recording) : recording_(recording) {}

  void add(const feature_tracker::FeatureTrackerResult& result) {
    const double t_s = recording_.motion.secondsAt(result.frame->stamp);
    const Pose T_wb = recording_.motion.poseAt(t_s);
    std::map<std::int64_t, Seen> now;
    for (const FeatureObservation& observation : result.frame->observations) {
      if (observation.camera != 0) continue;
      const auto known = seen_.find(observation.id);
      Seen seen{observation.track_length, std::nullopt};
      if (observation.track_length == 1) {
        seen.p_w = recording_.cameras[0].pointAt(T_wb, observation.pixel, t_s);
      } else if (known != seen_.end()) {
        seen.p_w = known->second.p_w;
        compare(observation, T_wb, seen.p_w);
      }
      if (truth_.images >= kSettled) truth_.ages.push_back(observation.track_length);
      now[observation.id] = seen;
    }
    for (const auto& [id, seen] : seen_) {
      if (now.count(id) == 0) truth_.lifetimes.push_back(seen.length);
    }
    seen_ = std::move(now);
    ++truth_.images;
    truth_.features += static_cast<double>(seen_.size());
    truth_.inlier_ratio += result.statistics.inlier_ratio;
  }

  TrackedTruth finish() const {
    TrackedTruth truth = truth_;
    truth.features /= truth.images;
    truth.inlier_ratio /= truth.images;
    return truth;
  }

 private:
  /// Images until ages are no longer cut short by the sequence's begin.
  static constexpr int kSettled = 40;

  struct Seen {
    int length = 0;
    std::optional<Eigen::Vector3d> p_w;
  };

  void compare(const FeatureObservation& observation, const Pose& T_wb,
               const std::optional<Eigen::Vector3d>& p_w) {
    const auto pixel = p_w ? recording_.cameras[0].project(T_wb, *p_w) : std::nullopt;
    const double error = pixel ? (*pixel - observation.pixel).norm() : 1e9;
    ++truth_.observations;
    if (error > 5.0) ++truth_.gross_outliers;
    if (observation.track_length != 11) return;
    ++truth_.aged;
    if (error <= 1.0) ++truth_.aged_within_a_pixel;
  }

  const SimulatedRecording& recording_;
  TrackedTruth truth_;
  std::map<std::int64_t, Seen> seen_;
};

/// Samples with stamps after `after` up to `up_to` [ns].
inline std::vector<ImuSample> samplesBetween(const SimulatedRecording& recording, Stamp after,
                                             Stamp up_to) {
  std::vector<ImuSample> samples;
  for (const ArrivedSample& arrived : recording.imu) {
    if (arrived.sample.stamp > after && arrived.sample.stamp <= up_to) {
      samples.push_back(arrived.sample);
    }
  }
  return samples;
}

/// Tracks all images of a recording, with the gyroscope or without.
inline TrackedTruth trackRecording(const SimulatedRecording& recording,
                                   const feature_tracker::FeatureTrackerOptions& options,
                                   bool gyroscope = true) {
  cv::setNumThreads(1);
  feature_tracker::FeatureTracker tracker({recording.rig.cameras[0]}, {recording.rig.T_bc[0]},
                                          options);
  TruthKeeper keeper(recording);
  Stamp last = 0;
  for (std::size_t i = 0; i < recording.image_stamps.size(); ++i) {
    const Stamp stamp = recording.image_stamps[i];
    const auto imu = gyroscope ? samplesBetween(recording, last, stamp) : std::vector<ImuSample>();
    keeper.add(tracker.track({recording.render(0, i)}, stamp, imu));
    last = stamp;
  }
  return keeper.finish();
}

}  // namespace vins::simulation
