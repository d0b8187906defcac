#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/quintic_basis.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins::simulation {

/// How the body moves at one instant. World: gravity points to -z; body = IMU.
struct MotionState {
  Pose T_wb;
  Eigen::Vector3d velocity_w = Eigen::Vector3d::Zero();              ///< [m/s]
  Eigen::Vector3d acceleration_w = Eigen::Vector3d::Zero();          ///< [m/s^2]
  Eigen::Vector3d angular_velocity_b = Eigen::Vector3d::Zero();      ///< [rad/s]
  Eigen::Vector3d angular_acceleration_b = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

/// A smooth motion: positions and rotations are cumulative B-splines of degree 5 with uniform
/// knots, four times continuously differentiable, with exact derivatives. Times are seconds since
/// epoch(), a stamp of the camera's clock.
class TrajectorySpline {
 public:
  /// Control pose j has its greatest weight at `begin_s` + (j - 2) `knot_interval_s`. Throws
  /// InputError where there are fewer than six, or the interval is not positive.
  TrajectorySpline(Stamp epoch, double begin_s, double knot_interval_s,
                   std::vector<Pose> control_poses);

  Stamp epoch() const { return epoch_; }
  double begin() const { return begin_; }  ///< [s]
  double end() const;                      ///< [s]
  double knotInterval() const { return knot_interval_; }
  const std::vector<Pose>& controlPoses() const { return control_poses_; }

  /// Seconds since epoch() of a stamp.
  double secondsAt(Stamp stamp) const { return toSeconds(stamp - epoch_); }

  /// The motion at `t_s` in [begin(), end()]; InputError elsewhere. Angular derivatives by the
  /// recurrences of C. Sommer et al., "Efficient derivative computation for cumulative B-splines
  /// on Lie groups", CVPR 2020, equations 33 and 38.
  MotionState at(double t_s) const;

  /// Only the pose of at().
  Pose poseAt(double t_s) const;

  /// The same motion, later by `delay` [ns].
  TrajectorySpline shiftedBy(Stamp delay) const;

 private:
  /// The control poses that matter at a time: from `first` on, with these weights.
  struct Place {
    std::size_t first;
    QuinticWeights weights;
  };
  Place placeAt(double t_s) const;

  Stamp epoch_;
  double begin_;
  double knot_interval_;
  std::vector<Pose> control_poses_;
  std::vector<Eigen::Vector3d> steps_;      ///< control position j+1 minus j [m]
  std::vector<Eigen::Vector3d> rotations_;  ///< rotation vector from control pose j to j+1 [rad]
};

}  // namespace vins::simulation
