#pragma once

#include <vector>

#include <Eigen/Core>

#include "vins_estimator/window/sliding_window.h"

namespace vins {

/// An observation, linearized: residual = J_host d_host + J_target d_target + J_landmark d_l + r,
/// weighted and scaled by the robust loss; d are error states of poses about their present values.
struct LinearizedObservation {
  std::size_t target = 0;  ///< index in the window of the frame that observes
  Eigen::Matrix<double, 2, 6> J_host;
  Eigen::Matrix<double, 2, 6> J_target;
  Eigen::Matrix<double, 2, 3> J_landmark;
  Eigen::Vector2d r;
};

/// A landmark's observations. The first is the host's own, which knows no pose.
struct LinearizedLandmark {
  std::size_t host = 0;  ///< index in the window
  std::vector<LinearizedObservation> observations;
};

/// `huber`: see WindowSolverOptions.
LinearizedLandmark linearize(const SlidingWindow& window, const Landmark& landmark, double huber);

/// Difference of a part's present value from its first estimate (zero where it has none).
Eigen::Matrix<double, 6, 1> poseShift(const WindowState& state);
Eigen::Matrix<double, 9, 1> motionShift(const WindowState& state);

/// Information of all states of the window, the landmarks eliminated: 15 rows for each frame, in
/// the order of ErrorState.
Eigen::MatrixXd windowInformation(const SlidingWindow& window, double huber);

/// Covariance of the newest state.
Matrix15d newestCovariance(const SlidingWindow& window, double huber);

}  // namespace vins
