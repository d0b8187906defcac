#include "simulation/scene_builder.h"

#include <algorithm>
#include <cmath>

namespace vins::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kLargestTexture = 2048;

int textureSide(double metres, double texels_per_m) {
  int side = 64;
  while (side < metres * texels_per_m && side < kLargestTexture) side *= 2;
  return side;
}

Eigen::AlignedBox3d boundsOf(const Solid& solid) {
  const Eigen::Matrix3d R = solid.pose.rotation.toRotationMatrix();
  const Vector3d reach = R.cwiseAbs() * solid.half;
  return {solid.pose.position - reach, solid.pose.position + reach};
}

Panel panelOf(const Vector3d& centre, const Vector3d& axis_s, const Vector3d& axis_t, double half_s,
              double half_t) {
  Panel panel;
  panel.centre = centre;
  panel.axis_s = axis_s;
  panel.axis_t = axis_t;
  panel.half_s = half_s;
  panel.half_t = half_t;
  return panel;
}

}  // namespace

bool ReservedSpace::touches(const Solid& solid) const {
  const Eigen::AlignedBox3d bounds = boundsOf(solid);
  return std::any_of(boxes.begin(), boxes.end(),
                     [&](const Eigen::AlignedBox3d& box) { return box.intersects(bounds); }) ||
         std::any_of(positions.begin(), positions.end(), [&](const Vector3d& p_w) {
           return bounds.squaredExteriorDistance(p_w) <= clearance * clearance &&
                  solid.distanceTo(p_w) <= clearance;
         });
}

std::vector<Panel> blockPanels(const Vector3d& half) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  std::vector<Panel> panels;
  for (const double side : {1.0, -1.0}) {
    // Upright pictures on the upright sides: axis_t is z.
    panels.push_back(panelOf(side * half.x() * x, side * y, z, half.y(), half.z()));
    panels.push_back(panelOf(side * half.y() * y, -side * x, z, half.x(), half.z()));
    panels.push_back(panelOf(side * half.z() * z, side * x, y, half.x(), half.y()));
  }
  return panels;
}

SceneBuilder::SceneBuilder(std::uint64_t seed) : seed_(seed), random_(seed, "scene") {}

void SceneBuilder::beginSection(const std::string& name, const Pose& T_ws) {
  section_ = name;
  T_ws_ = T_ws;
  random_ = Random(seed_, "scene " + name);
  textures_in_section_ = 0;
}

void SceneBuilder::addLight(const Vector3d& p_s, double power, double range) {
  lights_.push_back({T_ws_ * p_s, power, range});
}

void SceneBuilder::addPanel(const Vector3d& centre, const Vector3d& axis_s, const Vector3d& axis_t,
                            double half_s, double half_t, const Finish& finish) {
  Panel panel = panelOf(centre, axis_s, axis_t, half_s, half_t).movedBy(T_ws_);
  panel.texture = nextTexture(2.0 * half_s, 2.0 * half_t, finish);
  finishPanel(panel, finish);
}

void SceneBuilder::finishPanel(Panel panel, const Finish& finish) {
  panel.texels_per_m = finish.texels_per_m;
  panel.light = finish.glow;
  panel.gloss = {finish.gloss, finish.gloss_width_m, mirrored_lamp_w_};
  panels_.push_back(panel);
}

void SceneBuilder::addShell(const Eigen::AlignedBox3d& box, const Finish& floor,
                            const Finish& walls, const Finish& ceiling) {
  const Vector3d half = 0.5 * box.sizes();
  for (const Panel& side : blockPanels(half)) {
    const double up = side.normal().z();
    const Finish& finish = up > 0.5 ? ceiling : up < -0.5 ? floor : walls;
    // With one axis reversed the side is seen from inside.
    addPanel(box.center() + side.centre, -side.axis_s, side.axis_t, side.half_s, side.half_t,
             finish);
  }
}

void SceneBuilder::addBlock(const Pose& T_sb, const Vector3d& half, const Finish& finish) {
  const double longest = 2.0 * half.maxCoeff();
  const auto texture = nextTexture(longest, longest, finish);
  const Pose T_wb = T_ws_ * T_sb;
  for (const Panel& side : blockPanels(half)) {
    Panel panel = side.movedBy(T_wb);
    panel.texture = texture;
    panel.texture_origin.x() = random_.uniform(0.0, texture->width());
    panel.texture_origin.y() = random_.uniform(0.0, texture->height());
    finishPanel(panel, finish);
  }
  solids_.push_back({T_wb, half});
}

bool SceneBuilder::tryBlock(const Pose& T_sb, const Vector3d& half, const Finish& finish,
                            const ReservedSpace& reserved) {
  if (reserved.touches({T_ws_ * T_sb, half})) return false;
  addBlock(T_sb, half, finish);
  return true;
}

Scene SceneBuilder::build(const Eigen::AlignedBox3d& interior) const {
  std::vector<Panel> lit = panels_;
  for (Panel& panel : lit) {
    if (panel.light <= 0.0) lightUp(panel);
  }
  return Scene(std::move(lit), solids_, {}, interior);
}

std::shared_ptr<const Texture> SceneBuilder::nextTexture(double side_s, double side_t,
                                                         const Finish& finish) {
  const std::string name = section_ + " " + std::to_string(textures_in_section_++);
  auto& texture = textures_[name];
  if (!texture) {
    TextureOptions options;
    options.width = textureSide(side_s, finish.texels_per_m);
    options.height = textureSide(side_t, finish.texels_per_m);
    options.texels_per_m = finish.texels_per_m;
    options.style = finish.style;
    options.luminance = finish.luminance;
    texture = std::make_shared<const Texture>(makeNaturalTexture(seed_, name, options));
  }
  return texture;
}

double SceneBuilder::lightAt(const Vector3d& p_w, const Vector3d& normal) const {
  double light = ambient_light_;
  for (const Light& source : lights_) {
    const Vector3d ray = source.p_w - p_w;
    const double distance = ray.norm();
    const double facing = std::max(0.0, normal.dot(ray) / std::max(distance, 0.1));
    const double share = distance / source.range;
    // A third of it comes whichever way the panel faces: light that other surfaces throw back.
    light += source.power * (0.33 + 0.67 * facing) / (1.0 + share * share);
  }
  return light;
}

void SceneBuilder::lightUp(Panel& panel) const {
  const Vector3d normal = panel.normal();
  const Vector3d to_s = 0.6 * panel.half_s * panel.axis_s, to_t = 0.6 * panel.half_t * panel.axis_t;
  const double right = lightAt(panel.centre + to_s, normal);
  const double left = lightAt(panel.centre - to_s, normal);
  const double above = lightAt(panel.centre + to_t, normal);
  const double below = lightAt(panel.centre - to_t, normal);
  panel.light = std::min(0.25 * (right + left + above + below), 1.1);
  // Held back where the light would fall below a third of its middle at a corner.
  const double tilt_s = 0.5 * (right - left) / 0.6, tilt_t = 0.5 * (above - below) / 0.6;
  const double fall = std::abs(tilt_s) + std::abs(tilt_t);
  const double hold = std::min(1.0, 0.67 * panel.light / std::max(fall, 1e-9));
  panel.light_s = hold * tilt_s / panel.half_s;
  panel.light_t = hold * tilt_t / panel.half_t;
}

}  // namespace vins::simulation
