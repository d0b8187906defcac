#pragma once

#include <cstdint>

#include "simulation/scene.h"

namespace vins::simulation {

/// Half of the household room's sides [m].
constexpr double kHouseholdHalfSide = 2.1;

/// A bedroom of 4.2 x 4.2 x 2.5 m of weak texture: painted walls with faint joints, a bed with
/// bedding, a window (by day blown out, by night dark) with curtains, a desk with dark screens,
/// a door, a wardrobe, and few small things; lacquer and floor mirror the brightest lamp. One
/// corner is dark. The seed draws which furniture stands at which wall, its place and greys, and
/// day or night. Free: abs(x), abs(y) < 0.95, 0.9 < z < 2.2. World frame: z up, the floor at z = 0.
Scene makeHousehold(std::uint64_t seed);

}  // namespace vins::simulation
