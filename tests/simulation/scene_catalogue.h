#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/scene.h"

namespace vins::simulation {

/// The scenes of makeScene().
std::vector<std::string> sceneNames();

/// A scene by name; other seeds have other textures and clutter. World frame: z up, the floor at
/// z = 0, the origin in the middle of the floor. Each has space [m] that stays free of clutter.
///
/// - room: 8 x 6 x 4 m, with furniture, boards and posters. Free: abs(x) < 2.2, abs(y) < 1.4,
///   0.3 < z < 3.2.
/// - hall: 20 x 14 x 6 m, with pillars and machinery. Free: abs(x) < 8, abs(y) < 2.8, 0.3 < z < 5.
/// - corridor: 2.5 m wide and 3 m high around a block, outer walls 20 x 14 m. Free: 0.85 from the
///   centre line, the rectangle abs(x) = 8.75, abs(y) = 5.75; z < 2.7.
/// - corridor_alike: the same, both long sides alike (turned by 180 degrees about z).
/// - household: a bedroom of weak texture, see makeHousehold(). Free: abs(x), abs(y) < 0.95,
///   0.9 < z < 2.2.
/// - yard: 80 x 80 m, with containers, crates and a sky. Free: abs(x), abs(y) < 8, z < 12.
///
/// Throws InputError for other names.
Scene makeScene(const std::string& name, std::uint64_t seed);

enum class FittedStyle {
  kRoom,  ///< walls 2 m beyond the trajectory
  kHall   ///< walls 4 m beyond the trajectory
};

/// The room or hall around a trajectory. Nothing is nearer than `clearance` [m] to any of the
/// positions, which must be close enough together for that to mean anything. The floor lies 1 m
/// below the lowest position. Throws InputError without positions.
Scene sceneFittedTo(const std::vector<Eigen::Vector3d>& positions_w, std::uint64_t seed,
                    FittedStyle style, double clearance = 0.5);

/// A textured block that moves there and back along a line: its centre is
/// middle + swing sin(2 pi t / period) [m, s]. One that passes in front of what stands still.
MovingObject makeSwingingBlock(const Eigen::Vector3d& middle_w, const Eigen::Vector3d& swing,
                               double period_s, const Eigen::Vector3d& half, std::uint64_t seed);

}  // namespace vins::simulation
