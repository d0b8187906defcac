#include "vins_estimator/visual/landmarks.h"

#include <algorithm>

namespace vins::estimator {
namespace {

TrackObservation toObservation(FrameId frame, const FeatureObservation& feature, double pixel_noise,
                               int image_height) {
  TrackObservation observation;
  observation.frame = frame;
  observation.measured.bearing = feature.bearing;
  observation.measured.basis = tangentBasis(feature.bearing);
  observation.measured.inverse_sigma = 1.0 / (pixel_noise * feature.angular_resolution);
  observation.measured.row = image_height > 0 ? feature.pixel.y() / image_height : 0.0;
  observation.pixel = feature.pixel;
  observation.angular_resolution = feature.angular_resolution;
  return observation;
}

/// Makes observation `next` the host of a landmark that has depth.
void moveToHost(std::size_t next, const CameraPoses& cameras, Landmark* landmark) {
  const Eigen::Vector3d p_w = positionInWorld(*landmark, cameras.at(landmark->host()));
  const TrackObservation& host = landmark->observations[next];
  const Eigen::Vector3d p_c = cameras.at(host.frame).inverse() * p_w;
  const double along = host.measured.bearing.dot(p_c);
  // Behind its new host: what was known of it was wrong.
  if (!(along > 0.0)) {
    landmark->has_depth = false;
    return;
  }
  landmark->anchor = {host.measured.bearing, host.measured.basis, host.measured.row};
  landmark->parameters << host.measured.basis.transpose() * p_c / along, 1.0 / along;
}

/// Returns whether the track is empty now.
bool takeAway(FrameId frame, const CameraPoses& cameras, Landmark* landmark) {
  auto& observations = landmark->observations;
  const auto it = std::find_if(observations.begin(), observations.end(),
                               [&](const auto& o) { return o.frame == frame; });
  if (it == observations.end()) return false;
  if (observations.size() == 1) return true;
  if (it == observations.begin() && landmark->has_depth) moveToHost(1, cameras, landmark);
  observations.erase(it);
  if (observations.size() < 2) landmark->has_depth = false;
  return false;
}

}  // namespace

const TrackObservation* Landmark::observationIn(FrameId frame) const {
  const auto it = std::find_if(observations.begin(), observations.end(),
                               [&](const auto& o) { return o.frame == frame; });
  return it == observations.end() ? nullptr : &*it;
}

void Landmarks::addFrame(FrameId frame, const FeatureFrame& features) {
  for (const FeatureObservation& feature : features.observations) {
    if (feature.camera != 0) continue;
    Landmark& track = tracks_[feature.id];
    // A frame that names a track twice has its first word.
    if (!track.observations.empty() && track.observations.back().frame == frame) continue;
    track.id = feature.id;
    track.observations.push_back(toObservation(frame, feature, pixel_noise_, image_height_));
  }
}

void Landmarks::removeFrame(FrameId frame, const CameraPoses& cameras) {
  for (auto it = tracks_.begin(); it != tracks_.end();) {
    it = takeAway(frame, cameras, &it->second) ? tracks_.erase(it) : std::next(it);
  }
}

void Landmarks::removeObservation(std::int64_t id, FrameId frame, const CameraPoses& cameras) {
  const auto it = tracks_.find(id);
  if (it != tracks_.end() && takeAway(frame, cameras, &it->second)) tracks_.erase(it);
}

Eigen::Vector3d positionInWorld(const Landmark& landmark, const Pose& T_wc_host) {
  // A landmark at infinity is put far away in its direction.
  constexpr double kLeastInverseDistance = 1e-4;
  const double rho = std::max(landmark.parameters.z(), kLeastInverseDistance);
  return T_wc_host * Eigen::Vector3d(anchoredDirection(landmark.anchor, landmark.parameters) / rho);
}

}  // namespace vins::estimator
