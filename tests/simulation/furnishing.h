#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/scene_builder.h"

namespace vins::simulation {

/// What furnish() puts into a space.
struct Furniture {
  int blocks = 0;  ///< standing on the floor, at any yaw, some with smaller ones on top
  Eigen::Vector3d smallest_half = Eigen::Vector3d::Constant(0.2);  ///< of the blocks [m]
  Eigen::Vector3d largest_half = Eigen::Vector3d::Constant(0.5);   ///< of the blocks [m]
  double texels_per_m = 256.0;                                     ///< of the blocks
  int boards = 0;                                                  ///< thin, hanging in the air
  int posters = 0;                                                 ///< on the walls
};

/// Fills a space whose floor and walls are there, keeping off `reserved`. What finds no place after
/// some tries is left out.
void furnish(SceneBuilder& builder, const Eigen::AlignedBox3d& space, const Furniture& furniture,
             const ReservedSpace& reserved);

/// A grid of lights below the ceiling of a space.
void hangLamps(SceneBuilder& builder, const Eigen::AlignedBox3d& space, int columns, int rows);

}  // namespace vins::simulation
