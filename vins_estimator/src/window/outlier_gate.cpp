#include "vins_estimator/window/outlier_gate.h"

#include <utility>
#include <vector>

#include "vins_estimator/window/linearization.h"

namespace vins {
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

}  // namespace

int removeOutliers(const OutlierGateOptions& options, SlidingWindow* window) {
  const WindowGeometry geometry = geometryOf(*window);
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
  if (outliers.empty()) return 0;
  const CameraPoses cameras = window->cameras();
  for (const auto& [id, frame] : outliers) {
    window->landmarks.removeObservation(id, frame, cameras);
  }
  return static_cast<int>(outliers.size());
}

}  // namespace vins
