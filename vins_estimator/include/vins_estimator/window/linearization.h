#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "vins_estimator/window/sliding_window.h"

namespace vins {

/// Added to the diagonal of a landmark's own information, which may be next to nothing along its
/// depth.
constexpr double kLandmarkDamping = 1e-6;

/// An observation, linearized: residual = J_host d_host + J_target d_target + J_landmark d_l + r,
/// weighted; d are error states of poses about their present values.
struct LinearizedObservation {
  std::size_t target = 0;  ///< index in the window of the frame that observes
  Eigen::Matrix<double, 2, 6> J_host;
  Eigen::Matrix<double, 2, 6> J_target;
  Eigen::Matrix<double, 2, 3> J_landmark;
  Eigen::Vector2d r;
};

/// The window's views: at present, and where Jacobians are taken.
struct WindowGeometry {
  std::vector<ViewGeometry> present;
  std::vector<ViewGeometry> linearization;
};
/// `states`: present values of the frames' states.
WindowGeometry geometryOf(const SlidingWindow& window, const std::vector<NavState>& states);
/// At the values that the window has.
WindowGeometry geometryOf(const SlidingWindow& window);

/// Observation of a landmark of frame `host` by frame `target`; where both are the same it is the
/// host's own measurement, which knows no pose.
LinearizedObservation linearizeObservation(const BearingMeasurement& measured,
                                           const LandmarkAnchor& anchor,
                                           const WindowGeometry& geometry, std::size_t host,
                                           std::size_t target, const LandmarkParameters& landmark);

/// Its residual alone.
Eigen::Vector2d observationResidual(const BearingMeasurement& measured,
                                    const LandmarkAnchor& anchor, const WindowGeometry& geometry,
                                    std::size_t host, std::size_t target,
                                    const LandmarkParameters& landmark);

/// Scales by the square root of Huber's weight. `huber`: see WindowSolverOptions.
void scaleByLoss(double huber, LinearizedObservation* observation);

/// A landmark's observations. The first is the host's own.
struct LinearizedLandmark {
  std::size_t host = 0;  ///< index in the window
  std::vector<LinearizedObservation> observations;
};

/// All of a landmark's observations at the window's present values, scaled by the loss.
LinearizedLandmark linearize(const SlidingWindow& window, const WindowGeometry& geometry,
                             const Landmark& landmark, double huber);

/// Difference of a part's present value from its first estimate (zero where it has none).
Eigen::Matrix<double, 6, 1> poseShift(const WindowState& state);
Eigen::Matrix<double, 9, 1> motionShift(const WindowState& state);

}  // namespace vins
