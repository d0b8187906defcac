#include "vins_estimator/window/outlier_gate.h"

#include <limits>
#include <utility>
#include <vector>

#include "vins_estimator/window/linearization.h"

namespace vins {
namespace {

/// The frames whose observation of the landmark is beyond the gate.
std::vector<FrameId> outliersOf(const SlidingWindow& window, const Landmark& landmark,
                                double max_squared_residual) {
  // Without a robust loss: the residual itself counts.
  constexpr double kNoLoss = std::numeric_limits<double>::infinity();
  const LinearizedLandmark linearized = linearize(window, landmark, kNoLoss);
  std::vector<FrameId> frames;
  for (std::size_t i = 0; i < linearized.observations.size(); ++i) {
    const double squared = linearized.observations[i].r.squaredNorm();
    if (!(squared <= max_squared_residual)) frames.push_back(landmark.observations[i].frame);
  }
  return frames;
}

}  // namespace

int removeOutliers(const OutlierGateOptions& options, SlidingWindow* window) {
  std::vector<std::pair<std::int64_t, FrameId>> outliers;
  for (auto& [id, landmark] : window->landmarks.tracks()) {
    if (!landmark.has_depth) continue;
    const double rho = landmark.parameters.z();
    if (!(rho >= options.min_inverse_distance && rho <= options.max_inverse_distance)) {
      landmark.has_depth = false;
      continue;
    }
    for (const FrameId frame : outliersOf(*window, landmark, options.max_squared_residual)) {
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
