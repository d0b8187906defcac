#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// Added to the diagonal of a landmark's own information, which may be next to nothing along its
/// depth.
constexpr double kLandmarkDamping = 1e-6;

/// An observation, linearized: residual = J_host d_host + J_target d_target + J_landmark d_l +
/// J_rig d_rig + r, weighted; d are error states about the present values.
struct LinearizedObservation {
  std::size_t target = 0;  ///< index of the view that observes
  Eigen::Matrix<double, 2, 6> J_host;
  Eigen::Matrix<double, 2, 6> J_target;
  Eigen::Matrix<double, 2, 3> J_landmark;
  /// By the rig's errors that observations show; zero where they are not refined.
  Eigen::Matrix<double, 2, kCameraRigSize> J_rig;
  Eigen::Vector2d r;
};

/// The window's views, at present and where Jacobians are taken: the frames', then the old
/// keyframe's if there is one. A frame that was timed with another td than the present one shows
/// the world from where the body was when the camera saw it: its pose, carried over the difference
/// by its velocity and turn rate. (The feature tracks' own velocities would do as T. Qin and S.
/// Shen have it, "Online temporal calibration for monocular visual-inertial systems", IROS 2018;
/// but they share their noise with the residuals, which biases td by a millisecond.)
struct WindowGeometry {
  std::vector<ViewGeometry> present;
  std::vector<ViewGeometry> linearization;
  /// Change of a view's pose with td: position [m/s], rotation [rad/s, on the right].
  std::vector<Eigen::Matrix<double, 6, 1>> td_rates;
  /// Jacobians by the rig are wanted: not of views at rest, where nothing shows it but the noise of
  /// the poses would seem to.
  std::vector<bool> shows_rig;
  bool shows_camera = false;  ///< the same by read-out and intrinsics
};
WindowGeometry geometryOf(const SlidingWindow& window, const WindowValues& values);

/// Observation of a landmark of frame `host` by view `target`; where both are the same it is the
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

}  // namespace vins::estimator
