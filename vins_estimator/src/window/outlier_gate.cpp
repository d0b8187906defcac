#include "vins_estimator/window/outlier_gate.h"

#include <utility>
#include <vector>

#include "vins_estimator/window/linearization.h"

namespace vins::estimator {
namespace {

/// The frames whose observation of the landmark is beyond the gate.
std::vector<FrameId> outliersOf(const SlidingWindow& window, const WindowGeometry& geometry,
                                const Landmark& landmark, double max_squared_residual) {
  std::vector<FrameId> frames;
  const std::size_t host = window.indexOf(landmark.host());
  for (const TrackObservation& o : landmark.observations) {
    const Eigen::Vector2d r = observationResidual(o.measured, landmark.anchor, geometry, host,
                                                  window.indexOf(o.frame), landmark.parameters);
    if (!(r.squaredNorm() <= max_squared_residual)) frames.push_back(o.frame);
  }
  return frames;
}

/// Takes away what the old keyframe has seen elsewhere, or of landmarks that are no more.
int removeLoopOutliers(const WindowGeometry& geometry, double max_squared_residual,
                       SlidingWindow* window) {
  if (!window->loop) return 0;
  auto& measured = window->loop->measured;
  const std::size_t before = measured.size();
  const std::size_t old = window->frames.size();
  const auto& tracks = window->landmarks.tracks();
  for (auto it = measured.begin(); it != measured.end();) {
    const auto track = tracks.find(it->first);
    bool bad = track == tracks.end();
    if (!bad && track->second.has_depth) {
      const Landmark& landmark = track->second;
      const Eigen::Vector2d r =
          observationResidual(it->second, landmark.anchor, geometry,
                              window->indexOf(landmark.host()), old, landmark.parameters);
      bad = !(r.squaredNorm() <= max_squared_residual);
    }
    it = bad ? measured.erase(it) : std::next(it);
  }
  return static_cast<int>(before - measured.size());
}

}  // namespace

int removeOutliers(const OutlierGateOptions& options, SlidingWindow* window) {
  const WindowGeometry geometry = geometryOf(*window, window->values());
  std::vector<std::pair<std::int64_t, FrameId>> outliers;
  for (auto& [id, landmark] : window->landmarks.tracks()) {
    if (!landmark.has_depth) continue;
    const double rho = landmark.parameters.z();
    if (!(rho >= options.min_inverse_distance && rho <= options.max_inverse_distance)) {
      landmark.has_depth = false;
      continue;
    }
    for (const FrameId frame :
         outliersOf(*window, geometry, landmark, options.max_squared_residual)) {
      outliers.emplace_back(id, frame);
    }
  }
  int count = removeLoopOutliers(geometry, options.max_squared_residual, window);
  if (outliers.empty()) return count;
  const CameraPoses cameras = window->cameras();
  for (const auto& [id, frame] : outliers) {
    window->landmarks.removeObservation(id, frame, cameras);
  }
  return count + static_cast<int>(outliers.size());
}

}  // namespace vins::estimator
