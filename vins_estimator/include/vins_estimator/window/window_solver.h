#pragma once

#include <optional>

#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// Options of a window's solution.
struct WindowSolverOptions {
  int max_num_iterations = 8;
  double max_solver_time = 0.0;      ///< [s]; 0: no bound
  double function_tolerance = 1e-4;  ///< a step that changes the cost by a smaller part is the last
  double huber = 1.5;  ///< where bearings' loss turns from square to linear [deviations]
};

/// Where the query keyframe of a loop stands, in the body frame of the old keyframe.
struct LoopEstimate {
  Pose T_old_query;
  Eigen::Matrix<double, 6, 6> covariance;  ///< position [m], rotation [rad, on the right]
};

/// How a solution went.
struct SolveSummary {
  bool usable = false;  ///< false: nothing has been changed
  bool timed_out = false;
  int iterations = 0;
  int landmarks = 0;
  int observations = 0;
  double cost_initial = 0.0;
  double cost_final = 0.0;
  Matrix15d newest_covariance = Matrix15d::Zero();  ///< of the newest state, at the solution
  RigMatrix rig_covariance = RigMatrix::Zero();     ///< of the rig's errors; zero: no variable
  std::optional<LoopEstimate> loop;                 ///< of the window's loop
};

/// Moves the states and landmarks of the window to the least cost of prior, IMU and bearings
/// (VINS-Mono, equation 14). Ceres' Levenberg-Marquardt moves the poses; at each of its steps the
/// landmarks, velocities and biases go along, eliminated by WindowSystem (variable projection: G.
/// Golub, V. Pereyra, "Separable nonlinear least squares", Inverse Problems 2003). Ceres thus sees
/// one small dense residual, which costs a third of handing it each observation.
SolveSummary solveWindow(const WindowSolverOptions& options, SlidingWindow* window);

}  // namespace vins::estimator
