#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "simulation/scene.h"
#include "simulation/texture.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// Where a panel lies in the world: the part of a Panel that geometry needs.
struct PanelGeometry {
  Eigen::Vector3d centre, axis_s, axis_t, normal;
  double half_s = 0.0, half_t = 0.0;  ///< [m]
  double radius = 0.0;                ///< of its corners about the centre [m]
  bool glossy = false;
  Eigen::Vector3d lamp;  ///< that the panel mirrors, where it is glossy

  explicit PanelGeometry(const Panel& panel);
  PanelGeometry movedBy(const Pose& T) const;
};

/// A panel as a camera at one instant sees it. For the bearing b in the camera frame, with
/// d = b . normal: the distance is offset / d and the place on the panel ((b . s) / d, (b . t) /
/// d), each from -1 to 1. This is the homography of the panel's plane, written for bearings instead
/// of pixels (R. Hartley, A. Zisserman, "Multiple View Geometry", 2003, section 13.1). All zero
/// where the camera is behind the panel.
struct PanelView {
  std::array<float, 3> normal{}, s{}, t{};
  float offset = 0.0F;                     ///< [m], negative
  float mirror_s = 0.0F, mirror_t = 0.0F;  ///< place of the mirrored lamp; only of glossy panels

  PanelView() = default;
  PanelView(const PanelGeometry& panel, const Eigen::Matrix3d& R_cw, const Eigen::Vector3d& p_wc);

  /// Finds where the camera sees the lamp mirrored: on the line to the lamp's mirror image.
  void mirrorLamp(const PanelGeometry& panel, const Eigen::Vector3d& p_wc);

  static float dot(const std::array<float, 3>& a, float x, float y, float z) {
    return a[0] * x + a[1] * y + a[2] * z;
  }
};

/// How a panel looks, with places on it as fractions of its half sides, from -1 to 1.
struct PanelPaint {
  const Texture* texture;
  float origin_x, origin_y;  ///< texel at the centre
  float scale_s, scale_t;    ///< texels per half side
  float light, light_s, light_t;
  float gloss;             ///< luminance at the middle of the mirrored lamp
  float gloss_s, gloss_t;  ///< half sides per width of the mirrored lamp

  explicit PanelPaint(const Panel& panel);

  /// Of a place on the panel as it is seen in `view`.
  float luminance(const PanelView& view, float s, float t, const Footprint& footprint) const {
    const float matt = texture->sample(origin_x + scale_s * s, origin_y + scale_t * t, footprint) *
                       (light + light_s * s + light_t * t);
    return gloss > 0.0F ? matt + mirrored(view, s, t) : matt;
  }

  /// The lamp's mirror image: falls off smoothly with the distance from its middle.
  float mirrored(const PanelView& view, float s, float t) const {
    const float ds = gloss_s * (s - view.mirror_s), dt = gloss_t * (t - view.mirror_t);
    const float fall = 1.0F + ds * ds + dt * dt;
    return gloss / (fall * fall);
  }
};

/// A panel that some rays may meet, none of them nearer than min_distance.
struct Candidate {
  int panel = 0;
  float min_distance = 0.0F;  ///< [m]
};

/// What N neighbouring rays meet first.
template <int N>
struct RayPacket {
  alignas(16) float distance[N];
  alignas(16) float s[N];
  alignas(16) float t[N];
  alignas(16) int panel[N];  ///< -1 where a ray meets nothing

  /// Rays of bearings (x[i], y[i], z[i]); `candidates` in the order of their min_distance.
  void intersect(const std::vector<Candidate>& candidates, const PanelView* views, const float* x,
                 const float* y, const float* z);

 private:
  void meet(int index, const PanelView& view, const float* x, const float* y, const float* z);
};

template <int N>
void RayPacket<N>::intersect(const std::vector<Candidate>& candidates, const PanelView* views,
                             const float* x, const float* y, const float* z) {
  std::fill(distance, distance + N, std::numeric_limits<float>::max());
  std::fill(s, s + N, 0.0F);
  std::fill(t, t + N, 0.0F);
  std::fill(panel, panel + N, -1);
  for (const Candidate& candidate : candidates) {
    if (candidate.min_distance > *std::max_element(distance, distance + N)) return;
    meet(candidate.panel, views[candidate.panel], x, y, z);
  }
}

template <int N>
void RayPacket<N>::meet(int index, const PanelView& view, const float* x, const float* y,
                        const float* z) {
  // Selections instead of branches: the compiler makes vector instructions of them.
  for (int i = 0; i < N; ++i) {
    const float approach = PanelView::dot(view.normal, x[i], y[i], z[i]);
    const float inverse = 1.0F / approach;
    const float new_distance = view.offset * inverse;
    const float new_s = PanelView::dot(view.s, x[i], y[i], z[i]) * inverse;
    const float new_t = PanelView::dot(view.t, x[i], y[i], z[i]) * inverse;
    const bool met = (approach < 0.0F) & (new_distance < distance[i]) & (new_s * new_s <= 1.0F) &
                     (new_t * new_t <= 1.0F);
    distance[i] = met ? new_distance : distance[i];
    s[i] = met ? new_s : s[i];
    t[i] = met ? new_t : t[i];
    panel[i] = met ? index : panel[i];
  }
}

}  // namespace vins::simulation
