#pragma once

#include <ostream>

#include "simulation/trajectory_spline.h"
#include "vins_core/trajectory.h"

namespace vins::simulation {

/// How closely a spline follows recorded poses, and how much it smooths them. The defaults follow
/// EuRoC's ground truth to about a millimetre and leave its jitter out.
struct SplineFitOptions {
  double knot_interval = 0.02;       ///< [s]
  double margin = 0.1;               ///< known this long before the first, after the last pose [s]
  double position_deviation = 1e-3;  ///< noise of one recorded position [m]
  double rotation_deviation = 5e-4;  ///< noise of one recorded rotation [rad]
  double jerk_deviation = 40.0;      ///< usual size of the motion's jerk [m/s^3]
  double angular_jerk_deviation = 2000.0;  ///< of its angular acceleration's rate [rad/s^3]
  int iterations = 8;                      ///< Gauss-Newton steps for the rotations

  /// Throws InputError naming the first value that is not positive.
  void validate() const;
};

/// A spline and how far the recorded poses lie from it.
struct SplineFit {
  TrajectorySpline spline;
  double position_rms = 0.0;  ///< [m]
  double position_max = 0.0;  ///< [m]
  double rotation_rms = 0.0;  ///< [rad]
  double rotation_max = 0.0;  ///< [rad]
};

/// One line: residuals in mm and degrees.
std::ostream& operator<<(std::ostream& out, const SplineFit& fit);

/// The spline with the least squares of residuals and of third differences of the control points
/// (P. Eilers, B. Marx, "Flexible smoothing with B-splines and penalties", 1996), which bridge gaps
/// in the recording with little jerk. Its epoch is the first pose's stamp. Throws InputError where
/// the recording has fewer than two poses.
SplineFit fitSpline(const Trajectory& trajectory, const SplineFitOptions& options = {});

}  // namespace vins::simulation
