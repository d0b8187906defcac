#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "simulation/random.h"
#include "simulation/scene.h"
#include "simulation/texture_painting.h"

namespace vins::simulation {

/// Space that nothing may be put into.
struct ReservedSpace {
  std::vector<Eigen::AlignedBox3d> boxes;  ///< in the world
  std::vector<Eigen::Vector3d> positions;  ///< in the world, each with `clearance` around it
  double clearance = 0.0;                  ///< [m]

  bool touches(const Solid& solid) const;
};

/// The surface of a panel or block.
struct Finish {
  TextureStyle style = TextureStyle::kClutter;
  double texels_per_m = 256.0;
  double glow = 0.0;       ///< if positive, the light on it, whatever the lamps
  double luminance = 0.0;  ///< of a plain style; not positive: drawn
  double gloss = 0.0;      ///< luminance of the mirror image of setMirroredLamp()'s lamp
  double gloss_width_m = 0.15;
};

/// The six sides of a block about the origin, seen from outside, without texture.
std::vector<Panel> blockPanels(const Eigen::Vector3d& half);

/// Puts a scene together. Things are placed in the frame of the section at work, whose name
/// determines its random numbers and textures: two sections of one name look the same.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::uint64_t seed);

  /// What follows is placed in the frame T_ws.
  void beginSection(const std::string& name, const Pose& T_ws = Pose());

  /// Random numbers of the section.
  Random& random() { return random_; }

  /// Lights the panels that face it: at `range` [m] half as much as nearby.
  void addLight(const Eigen::Vector3d& p_s, double power, double range);

  /// Light from all around; 0.55 unless set.
  void setAmbientLight(double light) { ambient_light_ = light; }

  /// The lamp that glossy panels added from here on mirror.
  void setMirroredLamp(const Eigen::Vector3d& p_s) { mirrored_lamp_w_ = T_ws_ * p_s; }

  /// A rectangle with a texture of its own; see Panel for the side from which it is seen.
  void addPanel(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis_s,
                const Eigen::Vector3d& axis_t, double half_s, double half_t, const Finish& finish);

  /// The inside of a box.
  void addShell(const Eigen::AlignedBox3d& box, const Finish& floor, const Finish& walls,
                const Finish& ceiling);

  /// A solid block. Its sides are parts of one texture.
  void addBlock(const Pose& T_sb, const Eigen::Vector3d& half, const Finish& finish);

  /// The same unless it touches reserved space. Returns whether it was added.
  bool tryBlock(const Pose& T_sb, const Eigen::Vector3d& half, const Finish& finish,
                const ReservedSpace& reserved);

  /// The scene with its lights switched on.
  Scene build(const Eigen::AlignedBox3d& interior) const;

 private:
  struct Light {
    Eigen::Vector3d p_w;
    double power;
    double range;
  };
  std::shared_ptr<const Texture> nextTexture(double side_s, double side_t, const Finish& finish);
  double lightAt(const Eigen::Vector3d& p_w, const Eigen::Vector3d& normal) const;
  void lightUp(Panel& panel) const;
  /// Adds a panel that lies where it should, with what does not depend on its size.
  void finishPanel(Panel panel, const Finish& finish);

  std::uint64_t seed_;
  std::string section_;
  Pose T_ws_;
  Random random_;
  int textures_in_section_ = 0;
  std::map<std::string, std::shared_ptr<const Texture>> textures_;
  std::vector<Panel> panels_;
  std::vector<Solid> solids_;
  std::vector<Light> lights_;
  double ambient_light_ = 0.55;
  Eigen::Vector3d mirrored_lamp_w_ = Eigen::Vector3d::Zero();
};

}  // namespace vins::simulation
