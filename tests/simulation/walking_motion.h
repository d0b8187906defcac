#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/motion_design.h"
#include "simulation/random.h"

namespace vins::simulation {

/// How a person walks who films a room. Defaults: slow indoor steps with a hand-held device. Gait:
/// R. Margaria, "Biomechanics and energetics of muscular exercise", 1976 (the inverted pendulum);
/// the tremor is that of a recorded walk's IMU.
struct GaitOptions {
  double step_frequency = 1.8;        ///< [Hz]
  double walking_speed = 0.75;        ///< between the ramps of a leg [m/s]
  double leg_length = 0.9;            ///< of the inverted pendulum [m]
  double arm_share = 0.7;             ///< of the body's bob that the arms leave to the device
  double lateral_sway = 0.018;        ///< amplitude, at half the step frequency [m]
  double hand_height = 1.35;          ///< of the device above the floor [m]
  double half_side = 0.82;            ///< legs end within this distance of the middle [m]
  double max_turn_rate = 1.2;         ///< of turns on the spot [rad/s]
  double elevation = -0.30;           ///< of the optical axis on average [rad]
  double tremor_acceleration = 0.12;  ///< root mean square per axis [m/s^2]
  double tremor_rate = 0.03;          ///< root mean square per axis [rad/s]
};

/// A walk through a small room: legs from place to place, turns on the spot and pauses in which the
/// person looks around, with the bob and sway of steps and the tremor of a hand. At rest before
/// `begin` and after `end` [s]. Seeds draw the places, the pace and the phases.
class Walk {
 public:
  Walk(const GaitOptions& options, double begin, double end, std::uint64_t seed);

  DesignedPose at(double t) const;

  /// Share of the full walking speed at a time: 0 in turns and pauses.
  double activity(double t) const;

 private:
  /// From one place and heading to the next ones.
  struct Phase {
    double begin = 0.0;  ///< [s]
    double end = 0.0;    ///< [s]
    Eigen::Vector2d from = Eigen::Vector2d::Zero();
    Eigen::Vector2d to = Eigen::Vector2d::Zero();
    double yaw_from = 0.0;  ///< [rad]
    double yaw_to = 0.0;    ///< [rad]
  };
  Phase nextLeg(const Phase& last, Random* random) const;
  /// A turn on the spot, or a pause.
  Phase turnTowards(double yaw, const Phase& last, Random* random) const;
  Phase startedAfter(const Phase& turn, const Phase& leg, Random* random) const;
  /// The leg that looks more across the room than at the wall nearby.
  static Phase lookingAcross(const Phase& a, const Phase& b);
  const Phase& phaseAt(double t) const;
  /// The time in the phases: it slows down to a halt before the end.
  double walkingTime(double t) const;
  void addGait(double t, const Phase& phase, DesignedPose* pose) const;
  void addHand(double t, DesignedPose* pose) const;

  GaitOptions options_;
  double begin_;
  double end_;
  std::vector<Phase> phases_;
  double step_phase_;  ///< [rad]
  Sway pace_, arm_, look_, quick_, slow_;
};

}  // namespace vins::simulation
