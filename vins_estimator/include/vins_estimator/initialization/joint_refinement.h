#pragma once

#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"
#include "vins_estimator/initialization/initial_landmarks.h"

namespace vins::estimator {

/// Options of refineJointly().
struct JointRefinementOptions {
  double accelerometer_bias_sigma = 0.2;  ///< prior about zero [m/s^2]
  double gyroscope_bias_sigma = 0.1;      ///< prior about zero [rad/s]
  double position_sigma = 1e-3;           ///< of the convention that the first is the origin [m]
  double yaw_sigma = 1e-3;                ///< of the convention that the first has none [rad]
  double outlier_gate = 3.5;              ///< of a sighting after the adjustment [deviations]
  int max_iterations = 20;                ///< of an adjustment

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// States and landmarks, and the IMU between the states.
struct JointProblem {
  std::vector<NavState> states;            ///< in the world; gravity is (0, 0, -g)
  std::vector<Preintegration> imu;         ///< imu[i] from state i-1 to i; the first is empty
  std::vector<InitialLandmark> landmarks;  ///< hosts are cameras at T_bc
  Pose T_bc;
};

/// How well the joint adjustment went.
struct JointRefinement {
  bool converged = false;
  double visual_rms = 0.0;   ///< per axis [deviations]
  double squares = 0.0;      ///< of all residuals of images and IMU [deviations^2]
  double scale_sigma = 0.0;  ///< relative deviation of the path's size, from the information
  Vector15d sigma = Vector15d::Zero();  ///< deviations of the first state's errors
};

/// Adjusts states, biases and landmarks to images and IMU jointly, from a near start; rejects
/// outliers, integrates the IMU anew where the biases have moved, adjusts again. The first state
/// keeps its position and yaw by a prior.
///
/// `scale_sigma` is the deviation of the number by which the path about its centre is larger than
/// it should be: the covariance of the positions seen through that linear form. It and `sigma` are
/// larger by the root of the residuals' chi-square per degree of freedom where that is above one.
JointRefinement refineJointly(const JointRefinementOptions& options, JointProblem* problem);

}  // namespace vins::estimator
