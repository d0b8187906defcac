#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "vins_core/feature_frame.h"
#include "vins_core/pose.h"
#include "vins_estimator/factors/bearing_factor.h"

namespace vins::estimator {

/// A frame of the window, by a number that counts frames and is never used again.
using FrameId = std::int64_t;

/// A track's place in one frame.
struct TrackObservation {
  FrameId frame = 0;
  BearingMeasurement measured;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< [px]
  double angular_resolution = 0.0;                  ///< [rad/px]
};

/// A feature track in the window and, once it has depth, the landmark behind it. The oldest
/// observation's frame is its host.
struct Landmark {
  std::int64_t id = 0;
  std::vector<TrackObservation> observations;  ///< at least one; frames rising
  bool has_depth = false;
  LandmarkAnchor anchor;          ///< at the host; meaningful where it has depth
  LandmarkParameters parameters;  ///< (u, v, rho)

  FrameId host() const { return observations.front().frame; }
  /// Its place in a frame; null where it was not seen.
  const TrackObservation* observationIn(FrameId frame) const;
  bool isSeenIn(FrameId frame) const { return observationIn(frame) != nullptr; }
};

/// Where the camera stood when it took a frame (T_wc), asked by FrameId.
using CameraPoses = std::map<FrameId, Pose>;

/// The tracks of the window's frames. Only the first camera's features count.
class Landmarks {
 public:
  /// `pixel_noise`: deviation of a corner, per axis [px]; `image_height` [px], 0: not known, all
  /// rows count as the first.
  explicit Landmarks(double pixel_noise, int image_height = 0)
      : pixel_noise_(pixel_noise), image_height_(image_height) {}

  /// Appends the features of a frame newer than all before it.
  void addFrame(FrameId frame, const FeatureFrame& features);

  /// Takes a frame's observations away. Landmarks that it hosted move to their next observation,
  /// staying where they are in the world; tracks without observations go.
  void removeFrame(FrameId frame, const CameraPoses& cameras);

  /// Takes one observation away, as removeFrame() does.
  void removeObservation(std::int64_t id, FrameId frame, const CameraPoses& cameras);

  void remove(std::int64_t id) { tracks_.erase(id); }
  void clear() { tracks_.clear(); }

  /// By id, so that the order is the same everywhere.
  std::map<std::int64_t, Landmark>& tracks() { return tracks_; }
  const std::map<std::int64_t, Landmark>& tracks() const { return tracks_; }

 private:
  double pixel_noise_;
  int image_height_;
  std::map<std::int64_t, Landmark> tracks_;
};

/// Place in the world of a landmark that has depth, whose host's camera stood at T_wc [m].
Eigen::Vector3d positionInWorld(const Landmark& landmark, const Pose& T_wc_host);

}  // namespace vins::estimator
