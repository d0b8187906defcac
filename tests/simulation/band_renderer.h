#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/scene_renderer.h"

namespace vins::simulation {

/// Renders one band of tiles of an image: the work of one thread, for SceneRenderer only.
class BandRenderer {
 public:
  /// Writes the rows of the band into `luminance`.
  BandRenderer(const SceneRenderer& renderer, const ExposurePlan& plan, int band,
               cv::Mat& luminance);

  void run();

 private:
  static constexpr int kHalo = kTileSize + 4;  ///< a tile's row, its neighbours, and two to spare
  using HaloPacket = RayPacket<kHalo>;

  /// What a pixel that lies within one panel needs of it for all instants.
  struct Pixel {
    bool mixed = false;  ///< sees more than one panel
    int panel = -1;      ///< seen in the middle of the exposure
    Footprint footprint;

    bool hasFootprintOf(int other_panel) const { return !mixed && panel == other_panel; }
  };

  /// The panels at an instant: those that stand still, then those that move.
  std::vector<PanelGeometry> panelsAt(double t_s) const;
  std::vector<double> panelMotion(const std::vector<PanelGeometry>& panels) const;
  void findCandidates();
  void prepareViews();
  void renderTile(int tile);
  void findHits(int u);
  HaloPacket& hitsOf(int v, int sample) {
    return hits_[(kTileSize + 2) * sample + v - first_row_ + 1];
  }
  /// Pixels of a row that see, or have a neighbour that sees, another panel at any instant.
  std::array<int, kTileSize> mixedPixels(int v);
  std::array<Pixel, kTileSize> pixelsOfRow(int u, int v);
  void renderRow(int u, int v);
  float mixedPixel(int u, int v) const;
  Footprint footprint(const PanelView& view, int panel, const Eigen::Vector3f& bearing,
                      const Eigen::Vector3f& per_column, const Eigen::Vector3f& per_row) const;
  const PanelView* views(int v, int sample) const;

  const SceneRenderer& renderer_;
  const ExposurePlan& plan_;
  int band_;
  int first_row_;
  int last_row_;  ///< one beyond the last
  int middle_;    ///< the sample in the middle of the exposure
  cv::Mat& luminance_;
  std::vector<std::vector<Candidate>> candidates_;           ///< of each tile
  std::vector<PanelView> views_;                             ///< of all panels, instant by instant
  const std::vector<Candidate>* tile_candidates_ = nullptr;  ///< of the tile at work
  std::vector<HaloPacket> hits_;  ///< of the tile at work and the rows next to it, by instant
};

}  // namespace vins::simulation
