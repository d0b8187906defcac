#include "simulation/panel_view.h"

namespace vins::simulation {
namespace {

std::array<float, 3> toFloat(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

PanelGeometry::PanelGeometry(const Panel& panel)
    : centre(panel.centre),
      axis_s(panel.axis_s),
      axis_t(panel.axis_t),
      normal(panel.normal()),
      half_s(panel.half_s),
      half_t(panel.half_t),
      radius(panel.radius()),
      glossy(panel.gloss.strength > 0.0),
      lamp(panel.gloss.lamp_w) {}

PanelGeometry PanelGeometry::movedBy(const Pose& T) const {
  PanelGeometry moved = *this;
  moved.centre = T * centre;
  moved.axis_s = T.rotation * axis_s;
  moved.axis_t = T.rotation * axis_t;
  moved.normal = T.rotation * normal;
  return moved;
}

PanelPaint::PanelPaint(const Panel& panel)
    : texture(panel.texture.get()),
      origin_x(static_cast<float>(panel.texture_origin.x())),
      origin_y(static_cast<float>(panel.texture_origin.y())),
      scale_s(static_cast<float>(panel.texels_per_m * panel.half_s)),
      scale_t(static_cast<float>(panel.texels_per_m * panel.half_t)),
      light(static_cast<float>(panel.light)),
      light_s(static_cast<float>(panel.light_s * panel.half_s)),
      light_t(static_cast<float>(panel.light_t * panel.half_t)),
      gloss(static_cast<float>(panel.gloss.strength)),
      gloss_s(static_cast<float>(panel.half_s / panel.gloss.width_m)),
      gloss_t(static_cast<float>(panel.half_t / panel.gloss.width_m)) {}

PanelView::PanelView(const PanelGeometry& panel, const Eigen::Matrix3d& R_cw,
                     const Eigen::Vector3d& p_wc) {
  const Eigen::Vector3d to_centre = panel.centre - p_wc;
  const double height = to_centre.dot(panel.normal);
  if (height >= 0.0) return;
  // The place (distance b - to_centre) . axis with distance = height / d, times d / d.
  const Eigen::Vector3d s_w =
      (height * panel.axis_s - to_centre.dot(panel.axis_s) * panel.normal) / panel.half_s;
  const Eigen::Vector3d t_w =
      (height * panel.axis_t - to_centre.dot(panel.axis_t) * panel.normal) / panel.half_t;
  normal = toFloat(R_cw * panel.normal);
  s = toFloat(R_cw * s_w);
  t = toFloat(R_cw * t_w);
  offset = static_cast<float>(height);
  if (panel.glossy) mirrorLamp(panel, p_wc);
}

void PanelView::mirrorLamp(const PanelGeometry& panel, const Eigen::Vector3d& p_wc) {
  const double lamp_height = (panel.lamp - panel.centre).dot(panel.normal);
  const double camera_height = (p_wc - panel.centre).dot(panel.normal);
  if (lamp_height <= 0.0) {
    mirror_s = mirror_t = 1e6F;  // the lamp is behind the panel
    return;
  }
  const Eigen::Vector3d image = panel.lamp - 2.0 * lamp_height * panel.normal;
  const double share = camera_height / (camera_height + lamp_height);
  const Eigen::Vector3d place = p_wc + share * (image - p_wc) - panel.centre;
  mirror_s = static_cast<float>(place.dot(panel.axis_s) / panel.half_s);
  mirror_t = static_cast<float>(place.dot(panel.axis_t) / panel.half_t);
}

}  // namespace vins::simulation
