#pragma once

#include <cstdint>

#include "simulation/scene.h"
#include "simulation/trajectory_spline.h"

namespace vins::simulation {

/// The scene with `count` swinging blocks (half a metre to a metre across, up to 1.2 m to and fro)
/// that cross the view of a camera at T_bc on the trajectory between `begin_s` and `end_s` [s], 1.8
/// to 4 m in front of it. No block ever comes nearer than 0.6 m to the trajectory in that time or
/// leaves the scene. Throws InputError where no place for one is found in 2000 tries.
Scene withMovingObjects(const Scene& scene, int count, const TrajectorySpline& trajectory,
                        const Pose& T_bc, double begin_s, double end_s, std::uint64_t seed);

}  // namespace vins::simulation
