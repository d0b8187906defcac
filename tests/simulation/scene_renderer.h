#pragma once

#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/panel_view.h"
#include "simulation/ray_grid.h"
#include "simulation/scene.h"
#include "simulation/tile_culling.h"

namespace vins::simulation {

/// Where the camera is while it exposes: `samples` instants, the same ones for all rows or others
/// for each row.
struct ExposurePlan {
  struct Instant {
    Pose T_wc;
    double t_s = 0.0;  ///< [s]
  };
  int samples = 1;
  bool rolling = false;
  std::vector<Instant> instants;  ///< instant k, or instant row * samples + k where rolling

  const Instant& at(int row, int sample) const {
    return instants[rolling ? row * samples + sample : sample];
  }
};

/// Renders what a camera sees of a scene: the mean luminance of each pixel over its area and over
/// its exposure, without lens blur and noise. Within surfaces one ray per pixel and instant is
/// filtered by the texture's mip levels; pixels that see more than one panel get 16 rays or
/// more, across their area and all instants.
class SceneRenderer {
 public:
  SceneRenderer(std::shared_ptr<const Scene> scene, const camera_model::Camera& camera);

  /// Luminance as CV_32FC1, more than 1 where panels glow; 0 where the camera has no bearing or
  /// nothing is seen. The same for any number of threads.
  cv::Mat render(const ExposurePlan& plan, int threads) const;

 private:
  friend class BandRenderer;

  std::shared_ptr<const Scene> scene_;
  RayGrid rays_;
  FootprintFilter filter_;
  int tiles_per_band_;
  std::vector<TileCone> cones_;        ///< of all tiles, row by row
  std::vector<PanelGeometry> still_;   ///< of the scene's own panels
  std::vector<PanelGeometry> moving_;  ///< of all moving objects, in their frames
  std::vector<int> object_of_moving_;  ///< the object of each of moving_
  std::vector<PanelPaint> paints_;     ///< of still_, then of moving_
};

}  // namespace vins::simulation
