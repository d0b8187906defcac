#include "simulation/scene_renderer.h"

#include <utility>

#include "simulation/band_renderer.h"
#include "simulation/parallel_for.h"

namespace vins::simulation {

SceneRenderer::SceneRenderer(std::shared_ptr<const Scene> scene, const camera_model::Camera& camera)
    : scene_(std::move(scene)),
      rays_(camera),
      tiles_per_band_((rays_.width() + kTileSize - 1) / kTileSize) {
  for (int v = 0; v < rays_.height(); v += kTileSize) {
    for (int u = 0; u < rays_.width(); u += kTileSize) {
      cones_.push_back(TileCone::around(rays_, u, v));
    }
  }
  for (const Panel& panel : scene_->panels()) {
    still_.emplace_back(panel);
    paints_.emplace_back(panel);
  }
  int object_index = 0;
  for (const MovingObject& object : scene_->movingObjects()) {
    for (const Panel& panel : object.panels) {
      moving_.emplace_back(panel);
      object_of_moving_.push_back(object_index);
      paints_.emplace_back(panel);
    }
    ++object_index;
  }
}

cv::Mat SceneRenderer::render(const ExposurePlan& plan, int threads) const {
  cv::Mat luminance(rays_.height(), rays_.width(), CV_32FC1);
  const int bands = (rays_.height() + kTileSize - 1) / kTileSize;
  parallelFor(bands, threads, [&](int band) { BandRenderer(*this, plan, band, luminance).run(); });
  return luminance;
}

}  // namespace vins::simulation
