#pragma once

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "vins_core/pose.h"
#include "vins_core/tangent_basis.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/visual/bearing_correction.h"

namespace vins::estimator {

/// A landmark on the ray of the frame that hosts it (the first that observed it). In the host's
/// camera it lies at (bearing + basis (u, v)) / rho: rho is the inverse distance [1/m], u and v let
/// the ray differ from the host's own measurement [about rad], which is a measurement like all
/// others. (Holding the host's ray fixed, as VINS-Mono does, counts the host's noise as truth and
/// makes the estimate overconfident.)
struct LandmarkAnchor {
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  ///< measured by the host, unit
  Eigen::Matrix<double, 3, 2> basis;                   ///< tangentBasis(bearing)
  double row = 0.0;  ///< of the host's measurement, over the image's height
};

/// (u, v, rho) of a LandmarkAnchor.
using LandmarkParameters = Eigen::Vector3d;

/// Direction in the host's camera, times rho, of the landmark: bearing + basis (u, v).
Eigen::Vector3d anchoredDirection(const LandmarkAnchor& anchor, const LandmarkParameters& landmark);

/// A measured bearing with its weight.
struct BearingMeasurement {
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  ///< unit, in the observing camera
  Eigen::Matrix<double, 3, 2> basis;                   ///< tangentBasis(bearing)
  double inverse_sigma = 1.0;                          ///< [1/rad]
  double row = 0.0;                                    ///< over the image's height
};

/// A frame's body and camera in the world when the image's first row was read, as matrices; how the
/// camera moves, and what is known of its errors.
struct ViewGeometry {
  Eigen::Matrix3d R_wb;
  Eigen::Vector3d p_wb;
  Eigen::Matrix3d R_wc;
  Eigen::Vector3d p_wc;
  Eigen::Vector3d w_c = Eigen::Vector3d::Zero();  ///< angular velocity, camera frame [rad/s]
  Eigen::Vector3d v_c = Eigen::Vector3d::Zero();  ///< velocity, camera frame [m/s]
  Eigen::Vector3d a_c = Eigen::Vector3d::Zero();  ///< angular acceleration [rad/s^2]
  double readout = 0.0;                           ///< from the first row to the last [s]
  CameraIntrinsics intrinsics = CameraIntrinsics::Zero();
};
ViewGeometry viewGeometry(const Pose& T_wb, const Pose& T_bc);
/// The same camera with another pose of its body.
ViewGeometry movedTo(const Pose& T_wb, const Pose& T_bc, const ViewGeometry& view);

/// Derivatives of a weighted bearing residual.
struct BearingJacobians {
  Eigen::Matrix<double, 2, 6> J_host;    ///< by the host's pose (position, rotation)
  Eigen::Matrix<double, 2, 6> J_target;  ///< by the observing body's pose
  Eigen::Matrix<double, 2, 3> J_landmark;
};

/// Weighted residual, on the tangent plane at the measured bearing, of a landmark that `host` hosts
/// and `target` observes (VINS-Mono, equation 17), each at its own row's time: over the read-out
/// the camera's motion is taken as constant, its turn to first order. Jacobians are written where
/// `jacobians` is not null.
Eigen::Vector2d bearingResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const ViewGeometry& host, const ViewGeometry& target,
                                const LandmarkParameters& landmark, BearingJacobians* jacobians);

/// Derivative of bearingResidual() by T_bc (position, rotation).
Eigen::Matrix<double, 2, 6> extrinsicJacobian(const BearingMeasurement& measured,
                                              const LandmarkAnchor& anchor,
                                              const ViewGeometry& host, const ViewGeometry& target,
                                              const LandmarkParameters& landmark);

/// Derivative of bearingResidual() by the read-out, of the same one for both views.
Eigen::Vector2d readoutJacobian(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const ViewGeometry& host, const ViewGeometry& target,
                                const LandmarkParameters& landmark);

/// Derivative of bearingResidual() by the observing camera's intrinsics. It is taken where the
/// landmark is predicted: where it was measured its noise would make the focal lengths seem long
/// (the bias of regression on a noisy variable).
Eigen::Matrix<double, 2, 6> intrinsicsJacobian(const BearingMeasurement& measured,
                                               const LandmarkAnchor& anchor,
                                               const ViewGeometry& host, const ViewGeometry& target,
                                               const LandmarkParameters& landmark);
/// The same of hostResidual().
Eigen::Matrix<double, 2, 6> hostIntrinsicsJacobian(const BearingMeasurement& measured,
                                                   const LandmarkAnchor& anchor,
                                                   const LandmarkParameters& landmark);

/// Weighted residual of the host's own measurement, and its derivative by the landmark. Of the view
/// only the intrinsics matter.
Eigen::Vector2d hostResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                             const ViewGeometry& host, const LandmarkParameters& landmark,
                             Eigen::Matrix<double, 2, 3>* J_landmark);

/// bearingResidual() for Ceres, the extrinsic being constant. Parameter blocks: pose of the host
/// (7), pose of the target (7), landmark (3). What it refers to must outlive it. Jacobians by the
/// poses are taken at their first estimates where they have one.
class BearingFactor : public ceres::SizedCostFunction<2, 7, 7, 3> {
 public:
  BearingFactor(const BearingMeasurement& measured, const LandmarkAnchor& anchor, const Pose& T_bc,
                const WindowState& host, const WindowState& target)
      : measured_(measured), anchor_(anchor), T_bc_(T_bc), host_(host), target_(target) {}
  /// With what is known of the cameras' motion and errors; of the two views the poses do not count.
  BearingFactor(const BearingMeasurement& measured, const LandmarkAnchor& anchor, const Pose& T_bc,
                const WindowState& host, const WindowState& target, const ViewGeometry& host_view,
                const ViewGeometry& target_view)
      : BearingFactor(measured, anchor, T_bc, host, target) {
    host_view_ = host_view;
    target_view_ = target_view;
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const BearingMeasurement& measured_;
  const LandmarkAnchor& anchor_;
  const Pose& T_bc_;
  const WindowState& host_;
  const WindowState& target_;
  ViewGeometry host_view_;
  ViewGeometry target_view_;
};

/// The host's own measurement of its landmark. Parameter block: landmark (3).
class HostBearingFactor : public ceres::SizedCostFunction<2, 3> {
 public:
  HostBearingFactor(const BearingMeasurement& measured, const LandmarkAnchor& anchor)
      : measured_(measured), anchor_(anchor) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const BearingMeasurement& measured_;
  const LandmarkAnchor& anchor_;
};

}  // namespace vins::estimator
