#include "simulation/band_renderer.h"

#include <algorithm>
#include <cmath>

#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

/// So many pixels in a row share a footprint: it changes by a percent from one to the next, and
/// being symmetric it moves nothing.
constexpr int kSharedFootprint = 4;

/// Rays at each instant for a pixel that sees more than one panel: at least 16 in all.
int raysPerInstant(int samples) { return samples == 1 ? 16 : 8; }

/// Places of those rays about the pixel's centre [px]: Hammersley points, each coordinate of which
/// takes each of as many strata as there are rays once. From instant to instant they move through
/// the strata, so that all instants together tell finer positions of an edge.
Eigen::Vector2f placeOfRay(int index, int rays, int sample, int samples) {
  int reversed = 0;
  for (int bit = 1, mirror = rays / 2; bit < rays; bit *= 2, mirror /= 2) {
    if (index & bit) reversed += mirror;
  }
  const float within = (static_cast<float>(sample) + 0.5F) / static_cast<float>(samples);
  const auto stratum = [rays](int i) { return static_cast<float>(i) / static_cast<float>(rays); };
  const float step = stratum(1);
  return {stratum(index) + step * within - 0.5F, stratum(reversed) + step * (1.0F - within) - 0.5F};
}

/// How far two places of the same panel are apart at most, over the panel.
double motionBetween(const PanelGeometry& a, const PanelGeometry& b) {
  return (a.centre - b.centre).norm() + a.half_s * (a.axis_s - b.axis_s).norm() +
         a.half_t * (a.axis_t - b.axis_t).norm();
}

}  // namespace

BandRenderer::BandRenderer(const SceneRenderer& renderer, const ExposurePlan& plan, int band,
                           cv::Mat& luminance)
    : renderer_(renderer),
      plan_(plan),
      band_(band),
      first_row_(band * kTileSize),
      last_row_(std::min(first_row_ + kTileSize, renderer.rays_.height())),
      middle_(plan.samples / 2),
      luminance_(luminance),
      hits_((kTileSize + 2) * plan.samples) {}

void BandRenderer::run() {
  findCandidates();
  prepareViews();
  for (int tile = 0; tile < renderer_.tiles_per_band_; ++tile) renderTile(tile);
}

std::vector<PanelGeometry> BandRenderer::panelsAt(double t_s) const {
  std::vector<PanelGeometry> panels = renderer_.still_;
  for (std::size_t i = 0; i < renderer_.moving_.size(); ++i) {
    const auto& object = renderer_.scene_->movingObjects()[renderer_.object_of_moving_[i]];
    panels.push_back(renderer_.moving_[i].movedBy(object.pose_at(t_s)));
  }
  return panels;
}

std::vector<double> BandRenderer::panelMotion(const std::vector<PanelGeometry>& panels) const {
  const ExposurePlan::Instant& reference = plan_.at(first_row_, middle_);
  double camera_motion = 0.0;
  std::vector<double> motion(panels.size(), 0.0);
  for (int row = first_row_; row < (plan_.rolling ? last_row_ : first_row_ + 1); ++row) {
    for (int sample = 0; sample < plan_.samples; ++sample) {
      const ExposurePlan::Instant& instant = plan_.at(row, sample);
      const Eigen::Vector3d step = instant.T_wc.position - reference.T_wc.position;
      camera_motion = std::max(camera_motion, step.norm());
      if (renderer_.moving_.empty()) continue;
      const std::vector<PanelGeometry> now = panelsAt(instant.t_s);
      for (std::size_t i = renderer_.still_.size(); i < panels.size(); ++i) {
        motion[i] = std::max(motion[i], motionBetween(panels[i], now[i]));
      }
    }
  }
  for (double& m : motion) m += camera_motion;
  return motion;
}

void BandRenderer::findCandidates() {
  const ExposurePlan::Instant& reference = plan_.at(first_row_, middle_);
  double turn = 0.0;
  for (int row = first_row_; row < (plan_.rolling ? last_row_ : first_row_ + 1); ++row) {
    for (int sample = 0; sample < plan_.samples; ++sample) {
      turn = std::max(turn,
                      reference.T_wc.rotation.angularDistance(plan_.at(row, sample).T_wc.rotation));
    }
  }
  const std::vector<PanelGeometry> panels = panelsAt(reference.t_s);
  const TileCulling culling(panels, reference.T_wc.position, panelMotion(panels));
  candidates_.resize(renderer_.tiles_per_band_);
  for (int tile = 0; tile < renderer_.tiles_per_band_; ++tile) {
    const TileCone& cone = renderer_.cones_[band_ * renderer_.tiles_per_band_ + tile];
    if (cone.half_angle < 0.0) continue;
    culling.candidates(reference.T_wc.rotation * cone.axis, cone.half_angle + turn,
                       candidates_[tile]);
  }
}

void BandRenderer::prepareViews() {
  const std::size_t count = renderer_.paints_.size();
  std::vector<char> needed(count, 0);
  for (const auto& tile : candidates_) {
    for (const Candidate& candidate : tile) needed[candidate.panel] = 1;
  }
  const int rows = plan_.rolling ? last_row_ - first_row_ : 1;
  views_.resize(count * rows * plan_.samples);
  const bool any_moving = !renderer_.moving_.empty();
  PanelView* view = views_.data();
  for (int row = first_row_; row < first_row_ + rows; ++row) {
    for (int sample = 0; sample < plan_.samples; ++sample, view += count) {
      const ExposurePlan::Instant& instant = plan_.at(row, sample);
      const Eigen::Matrix3d R_cw = instant.T_wc.rotation.conjugate().toRotationMatrix();
      const auto moved = any_moving ? panelsAt(instant.t_s) : std::vector<PanelGeometry>();
      const std::vector<PanelGeometry>& panels = any_moving ? moved : renderer_.still_;
      for (std::size_t i = 0; i < count; ++i) {
        if (needed[i]) view[i] = PanelView(panels[i], R_cw, instant.T_wc.position);
      }
    }
  }
}

const PanelView* BandRenderer::views(int v, int sample) const {
  const int row = plan_.rolling ? std::clamp(v, first_row_, last_row_ - 1) - first_row_ : 0;
  return views_.data() + renderer_.paints_.size() * (row * plan_.samples + sample);
}

void BandRenderer::renderTile(int tile) {
  const int u = tile * kTileSize;
  tile_candidates_ = &candidates_[tile];
  findHits(u);
  for (int v = first_row_; v < last_row_; ++v) renderRow(u, v);
}

void BandRenderer::findHits(int u) {
  const RayGrid& rays = renderer_.rays_;
  for (int sample = 0; sample < plan_.samples; ++sample) {
    for (int v = first_row_ - 1; v <= last_row_; ++v) {
      hitsOf(v, sample).intersect(*tile_candidates_, views(v, sample), rays.x(u - 1, v),
                                  rays.y(u - 1, v), rays.z(u - 1, v));
    }
  }
}

std::array<int, kTileSize> BandRenderer::mixedPixels(int v) {
  std::array<int, kTileSize> mixed{};
  const int* const middle = hitsOf(v, middle_).panel + 1;
  for (int sample = 0; sample < plan_.samples; ++sample) {
    for (int row = v - 1; row <= v + 1; ++row) {
      for (int offset = 0; offset < 3; ++offset) {
        const int* const neighbour = hitsOf(row, sample).panel + offset;
        for (int i = 0; i < kTileSize; ++i) mixed[i] |= neighbour[i] != middle[i] ? 1 : 0;
      }
    }
  }
  return mixed;
}

Footprint BandRenderer::footprint(const PanelView& view, int panel, const Eigen::Vector3f& bearing,
                                  const Eigen::Vector3f& per_column,
                                  const Eigen::Vector3f& per_row) const {
  const auto dot = [](const std::array<float, 3>& a, const Eigen::Vector3f& b) {
    return PanelView::dot(a, b.x(), b.y(), b.z());
  };
  const float inverse = 1.0F / dot(view.normal, bearing);
  const float s = dot(view.s, bearing) * inverse, t = dot(view.t, bearing) * inverse;
  const PanelPaint& paint = renderer_.paints_[panel];
  const float scale_s = inverse * paint.scale_s, scale_t = inverse * paint.scale_t;
  // Quotient rule for (b . s) / (b . normal).
  const float column_normal = dot(view.normal, per_column);
  const float row_normal = dot(view.normal, per_row);
  return renderer_.filter_.footprint(scale_s * (dot(view.s, per_column) - s * column_normal),
                                     scale_t * (dot(view.t, per_column) - t * column_normal),
                                     scale_s * (dot(view.s, per_row) - s * row_normal),
                                     scale_t * (dot(view.t, per_row) - t * row_normal));
}

std::array<BandRenderer::Pixel, kTileSize> BandRenderer::pixelsOfRow(int u, int v) {
  const PanelView* const view = views(v, middle_);
  const std::array<int, kTileSize> mixed = mixedPixels(v);
  std::array<Pixel, kTileSize> pixels;
  const int columns = std::min(kTileSize, renderer_.rays_.width() - u);
  for (int i = 0; i < columns; ++i) {
    Pixel& pixel = pixels[i];
    pixel.panel = hitsOf(v, middle_).panel[i + 1];
    pixel.mixed = mixed[i] != 0;
    if (pixel.mixed || pixel.panel < 0) continue;
    if (i % kSharedFootprint != 0 && pixels[i - 1].hasFootprintOf(pixel.panel)) {
      pixel.footprint = pixels[i - 1].footprint;
      continue;
    }
    pixel.footprint =
        footprint(view[pixel.panel], pixel.panel, renderer_.rays_.bearing(u + i, v),
                  renderer_.rays_.perColumn(u + i, v), renderer_.rays_.perRow(u + i, v));
  }
  return pixels;
}

void BandRenderer::renderRow(int u, int v) {
  const std::array<Pixel, kTileSize> pixels = pixelsOfRow(u, v);
  const int columns = std::min(kTileSize, renderer_.rays_.width() - u);
  std::array<float, kTileSize> sums{};
  for (int sample = 0; sample < plan_.samples; ++sample) {
    const HaloPacket& hits = hitsOf(v, sample);
    const PanelView* const view = views(v, sample);
    for (int i = 0; i < columns; ++i) {
      const Pixel& pixel = pixels[i];
      if (pixel.mixed || pixel.panel < 0) continue;
      sums[i] += renderer_.paints_[pixel.panel].luminance(view[pixel.panel], hits.s[i + 1],
                                                          hits.t[i + 1], pixel.footprint);
    }
  }
  float* const out = luminance_.ptr<float>(v) + u;
  for (int i = 0; i < columns; ++i) {
    out[i] = pixels[i].mixed ? mixedPixel(u + i, v) : sums[i] / static_cast<float>(plan_.samples);
  }
}

float BandRenderer::mixedPixel(int u, int v) const {
  const Eigen::Vector3f per_column = renderer_.rays_.perColumn(u, v);
  const Eigen::Vector3f per_row = renderer_.rays_.perRow(u, v);
  const int rays = raysPerInstant(plan_.samples);
  float sum = 0.0F;
  int footprint_panel = -1;
  Footprint footprint_of_panel;
  for (int i = 0; i < rays * plan_.samples; ++i) {
    const PanelView* const view = views(v, i / rays);
    const Eigen::Vector2f place = placeOfRay(i % rays, rays, i / rays, plan_.samples);
    const Eigen::Vector3f bearing =
        renderer_.rays_.bearing(u, v) + place.x() * per_column + place.y() * per_row;
    RayPacket<1> hit;
    hit.intersect(*tile_candidates_, view, &bearing.x(), &bearing.y(), &bearing.z());
    const int panel = hit.panel[0];
    if (panel < 0) continue;
    if (panel != footprint_panel) {
      // Half a pixel wide: the rays themselves are spread over the pixel.
      footprint_of_panel =
          footprint(view[panel], panel, bearing, 0.5F * per_column, 0.5F * per_row);
      footprint_panel = panel;
    }
    sum += renderer_.paints_[panel].luminance(view[panel], hit.s[0], hit.t[0], footprint_of_panel);
  }
  return sum / static_cast<float>(rays * plan_.samples);
}

}  // namespace vins::simulation
