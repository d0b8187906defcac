#include "vins_estimator/window/window_output.h"

namespace vins::estimator {

std::vector<LandmarkPoint> landmarkPoints(const SlidingWindow& window) {
  std::vector<LandmarkPoint> points;
  const CameraPoses cameras = window.cameras();
  for (const auto& [id, track] : window.landmarks.tracks()) {
    if (track.has_depth) points.push_back({id, positionInWorld(track, cameras.at(track.host()))});
  }
  return points;
}

Keyframe keyframeOf(const SlidingWindow& window, std::size_t index, std::uint32_t sequence) {
  const WindowFrame& frame = window.frames[index];
  Keyframe keyframe;
  keyframe.id = frame.keyframe_id;
  keyframe.sequence = sequence;
  keyframe.stamp = frame.stamp;
  keyframe.chosen_at = window.frames.back().stamp;
  keyframe.T_wb = window.atImage(frame).T_wb;
  keyframe.T_bc = window.rig.T_bc;
  keyframe.covariance = frame.covariance.topLeftCorner<6, 6>();
  const CameraPoses cameras = window.cameras();
  for (const auto& [id, track] : window.landmarks.tracks()) {
    if (!track.has_depth) continue;
    for (const TrackObservation& o : track.observations) {
      if (o.frame != frame.id) continue;
      keyframe.points.push_back(
          {id, o.pixel, o.measured.bearing, positionInWorld(track, cameras.at(track.host()))});
    }
  }
  return keyframe;
}

KeyframePoseUpdate poseUpdateOf(const SlidingWindow& window, const WindowFrame& frame,
                                std::uint32_t sequence) {
  return {frame.keyframe_id, sequence, frame.stamp, window.atImage(frame).T_wb};
}

}  // namespace vins::estimator
