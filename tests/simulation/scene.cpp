#include "simulation/scene.h"

#include <cmath>
#include <utility>

namespace vins::simulation {
namespace {

/// Takes over `hit` where the ray meets the panel nearer. Returns whether it did.
bool meet(const Panel& panel, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
          Hit& hit) {
  const Eigen::Vector3d normal = panel.normal();
  const double approach = direction.dot(normal);
  if (approach >= 0.0) return false;
  const Eigen::Vector3d to_centre = panel.centre - origin;
  const double distance = to_centre.dot(normal) / approach;
  if (!(distance > 0.0) || distance >= hit.distance) return false;
  const Eigen::Vector3d offset = distance * direction - to_centre;
  const double s = offset.dot(panel.axis_s), t = offset.dot(panel.axis_t);
  if (std::abs(s) > panel.half_s || std::abs(t) > panel.half_t) return false;
  hit.distance = distance;
  hit.luminance = panel.luminanceAt(s, t);
  return true;
}

}  // namespace

Panel Panel::movedBy(const Pose& T) const {
  Panel moved = *this;
  moved.centre = T * centre;
  moved.axis_s = T.rotation * axis_s;
  moved.axis_t = T.rotation * axis_t;
  return moved;
}

double Panel::luminanceAt(double s, double t) const {
  const Eigen::Vector2d texel = texture_origin + texels_per_m * Eigen::Vector2d(s, t);
  const float value =
      texture->sample(static_cast<float>(texel.x()), static_cast<float>(texel.y()), 0.0F);
  return value * (light + light_s * s + light_t * t);
}

double Solid::distanceTo(const Eigen::Vector3d& p_w) const {
  const Eigen::Vector3d p = pose.inverse() * p_w;
  return (p.cwiseAbs() - half).cwiseMax(0.0).norm();
}

Scene::Scene(std::vector<Panel> panels, std::vector<Solid> solids,
             std::vector<MovingObject> objects, const Eigen::AlignedBox3d& interior)
    : panels_(std::move(panels)),
      solids_(std::move(solids)),
      objects_(std::move(objects)),
      interior_(interior) {}

std::optional<Hit> Scene::intersect(const Eigen::Vector3d& origin_w,
                                    const Eigen::Vector3d& direction_w, double t_s) const {
  Hit hit;
  const int panels = static_cast<int>(panels_.size()), objects = static_cast<int>(objects_.size());
  for (int i = 0; i < panels; ++i) {
    if (meet(panels_[i], origin_w, direction_w, hit)) hit.panel = i;
  }
  for (int object = 0; object < objects; ++object) {
    const Pose T_ow = objects_[object].pose_at(t_s).inverse();
    const Eigen::Vector3d origin = T_ow * origin_w, direction = T_ow.rotation * direction_w;
    const int sides = static_cast<int>(objects_[object].panels.size());
    for (int i = 0; i < sides; ++i) {
      if (!meet(objects_[object].panels[i], origin, direction, hit)) continue;
      hit.panel = i;
      hit.object = object;
    }
  }
  if (hit.panel < 0) return std::nullopt;
  return hit;
}

bool Scene::isFree(const Eigen::Vector3d& p_w, double clearance) const {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(clearance);
  if (((p_w - margin).array() < interior_.min().array()).any()) return false;
  if (((p_w + margin).array() > interior_.max().array()).any()) return false;
  for (const Solid& solid : solids_) {
    if (solid.distanceTo(p_w) <= clearance) return false;
  }
  for (const MovingObject& object : objects_) {
    if (object.reach.exteriorDistance(p_w) <= clearance) return false;
  }
  return true;
}

Scene Scene::with(const MovingObject& object) const {
  Scene extended = *this;
  extended.objects_.push_back(object);
  return extended;
}

}  // namespace vins::simulation
