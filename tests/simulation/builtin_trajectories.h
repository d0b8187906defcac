#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/euroc_rig.h"
#include "simulation/trajectory_spline.h"

namespace vins::simulation {

/// The trajectories of makeBuiltinTrajectory().
std::vector<std::string> builtinTrajectoryNames();

/// A scene of makeScene() in whose free space the trajectory stays.
std::string sceneOfBuiltinTrajectory(const std::string& name);

/// A motion of `duration` [s] by name, the same for the same seed; other seeds sway and speed up
/// otherwise. World: z up, the floor at z = 0.
///
/// | name             | what                                                                      |
/// |------------------|---------------------------------------------------------------------------|
/// | hall_loop        | rounds through a hall, back to the start; 0.5 to 1.7 m/s                  |
/// | figure_eight     | a lying eight through a hall; 0.5 to 1.7 m/s                              |
/// | corridor         | rounds through four corridors about a block, back to the start; ~1.1 m/s  |
/// | hover            | on the spot but for some centimetres and degrees                          |
/// | still            | exactly at rest                                                           |
/// | pure_rotation    | 15 s of turning about the camera's centre, then rounds in a room          |
/// | static_then_move | 4 s exactly at rest near the floor, take-off in 3 s, then rounds in a hall|
/// | walk             | a person who films a room: steps, turns on the spot, pauses; see Walk     |
/// | fast             | tight rounds in a room: up to 2.5 m/s, 3 rad/s and 8 m/s^2               |
///
/// All begin and end exactly at rest (0.3 s of it), at t = 0 and t = duration; speed then rises
/// and falls smoothly within about 2 s. Rounds are shrunk so that a whole number of them fits, but
/// for the corridor's, whose speed is changed (below 38 s there is no time to come round). The
/// camera at T_bc looks ahead along the path (in a room: about one direction), roughly level, and
/// the body leans into its accelerations as a multirotor does (but for the
/// walk). The epoch is `epoch`. The trajectory
/// is known from 1 s before t = 0 to 1 s after the end. Throws InputError for other names and for a
/// duration that is not in 1 to 36000 s.
TrajectorySpline makeBuiltinTrajectory(const std::string& name, std::uint64_t seed, double duration,
                                       const Pose& T_bc = eurocCameraInBody(0), Stamp epoch = 0);

}  // namespace vins::simulation
