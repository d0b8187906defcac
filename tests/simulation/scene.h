#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/texture.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// The mirror image of a lamp in a panel, which moves over it as the camera moves.
struct Gloss {
  double strength = 0.0;  ///< luminance at the middle of the mirror image; 0: a matt panel
  double width_m = 0.15;  ///< of the mirror image on the panel
  Eigen::Vector3d lamp_w = Eigen::Vector3d::Zero();  ///< [m]
};

/// A textured rectangle, seen from the side that its normal axis_s x axis_t points to; from behind
/// it is not there. A place on it is centre + s axis_s + t axis_t with |s| <= half_s, |t| <= half_t
/// [m].
struct Panel {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Vector3d axis_s = Eigen::Vector3d::UnitX();  ///< unit
  Eigen::Vector3d axis_t = Eigen::Vector3d::UnitY();  ///< unit, at right angles to axis_s
  double half_s = 1.0;                                ///< [m]
  double half_t = 1.0;                                ///< [m]
  std::shared_ptr<const Texture> texture;
  double texels_per_m = 256.0;
  Eigen::Vector2d texture_origin = Eigen::Vector2d::Zero();  ///< texel at the centre
  double light = 1.0;    ///< luminance is the texture's times the light that falls on the place,
  double light_s = 0.0;  ///< light + light_s s + light_t t [light and light per m]
  double light_t = 0.0;
  Gloss gloss;

  Eigen::Vector3d normal() const { return axis_s.cross(axis_t); }
  double radius() const { return std::hypot(half_s, half_t); }
  /// The same panel on a body at this pose.
  Panel movedBy(const Pose& T) const;
  /// Luminance at a place on the panel, at the texture's full resolution and without gloss. More
  /// than 1 is more than the sensor takes.
  double luminanceAt(double s, double t) const;
};

/// A block at any attitude.
struct Solid {
  Pose pose;                                              ///< of the block's centre in the world
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);  ///< half of its sides [m]

  /// Distance of a point in the world from the block [m], 0 inside.
  double distanceTo(const Eigen::Vector3d& p_w) const;
};

/// Panels that move together, as a rigid body.
struct MovingObject {
  std::vector<Panel> panels;                ///< in the body's frame
  std::function<Pose(double t_s)> pose_at;  ///< body in the world; smooth, safe to call at any time
  Eigen::AlignedBox3d reach;                ///< of the world, all that it ever touches
};

/// What a ray meets first.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  double luminance = 0.0;                                     ///< at the texture's full resolution
  int panel = -1;   ///< index in panels(), or in the object's panels
  int object = -1;  ///< index in movingObjects(), or -1 for what stands still
};

/// A world of textured panels to look at and of solid blocks not to fly through. World frame: z up.
class Scene {
 public:
  /// The free space lies within `interior`, outside of `solids` and of the moving objects' reach.
  Scene(std::vector<Panel> panels, std::vector<Solid> solids, std::vector<MovingObject> objects,
        const Eigen::AlignedBox3d& interior);

  const std::vector<Panel>& panels() const { return panels_; }
  const std::vector<Solid>& solids() const { return solids_; }
  const std::vector<MovingObject>& movingObjects() const { return objects_; }
  const Eigen::AlignedBox3d& interior() const { return interior_; }

  /// The nearest panel that the ray from `origin_w` along the unit vector `direction_w` meets, at
  /// `t_s` (only moving objects depend on it).
  std::optional<Hit> intersect(const Eigen::Vector3d& origin_w, const Eigen::Vector3d& direction_w,
                               double t_s = 0.0) const;

  /// Nothing solid, and no place that a moving object ever touches, is nearer than `clearance` [m].
  bool isFree(const Eigen::Vector3d& p_w, double clearance) const;

  /// The same scene with one more moving object.
  Scene with(const MovingObject& object) const;

 private:
  std::vector<Panel> panels_;
  std::vector<Solid> solids_;
  std::vector<MovingObject> objects_;
  Eigen::AlignedBox3d interior_;
};

}  // namespace vins::simulation
