#pragma once

#include <functional>
#include <vector>

#include "camera_model/camera.h"
#include "simulation/image_options.h"
#include "simulation/scene.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// How a camera chooses its exposure. It follows the mean of what it sees with a lag, first by the
/// shutter's time, then by the gain.
struct AutoExposure {
  double target = 0.36;           ///< mean of the image, as a share of white
  double reference_s = 0.010;     ///< luminance 1 is white after this time at gain 1 [s]
  double min_exposure_s = 0.005;  ///< [s]
  double max_exposure_s = 0.030;  ///< [s]
  double max_gain = 8.0;
  double lag_s = 0.35;  ///< time constant [s]

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// The settings from `begin` to `end` [s of the motion], a tenth of a second apart.
std::vector<ExposureSetting> planExposure(const Scene& scene, const camera_model::Camera& camera,
                                          const std::function<Pose(double t_s)>& T_wc, double begin,
                                          double end, const AutoExposure& options);

}  // namespace vins::simulation
