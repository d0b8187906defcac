#pragma once

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "vins_core/pose.h"
#include "vins_core/tangent_basis.h"
#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// A landmark on the ray of the frame that hosts it (the first that observed it). In the host's
/// camera it lies at (bearing + basis (u, v)) / rho: rho is the inverse distance [1/m], u and v let
/// the ray differ from the host's own measurement [about rad], which is a measurement like all
/// others. (Holding the host's ray fixed, as VINS-Mono does, counts the host's noise as truth and
/// makes the estimate overconfident.)
struct LandmarkAnchor {
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  ///< measured by the host, unit
  Eigen::Matrix<double, 3, 2> basis;                   ///< tangentBasis(bearing)
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
};

/// A frame's body and camera in the world, as matrices.
struct ViewGeometry {
  Eigen::Matrix3d R_wb;
  Eigen::Vector3d p_wb;
  Eigen::Matrix3d R_wc;
  Eigen::Vector3d p_wc;
};
ViewGeometry viewGeometry(const Pose& T_wb, const Pose& T_bc);

/// Derivatives of a weighted bearing residual.
struct BearingJacobians {
  Eigen::Matrix<double, 2, 6> J_host;    ///< by the host's pose (position, rotation)
  Eigen::Matrix<double, 2, 6> J_target;  ///< by the observing body's pose
  Eigen::Matrix<double, 2, 3> J_landmark;
};

/// Weighted residual, on the tangent plane at the measured bearing, of a landmark that `host` hosts
/// and `target` observes (VINS-Mono, equation 17). Jacobians are written where `jacobians` is not
/// null.
Eigen::Vector2d bearingResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                                const ViewGeometry& host, const ViewGeometry& target,
                                const LandmarkParameters& landmark, BearingJacobians* jacobians);

/// Derivative of bearingResidual() by T_bc (position, rotation).
Eigen::Matrix<double, 2, 6> extrinsicJacobian(const BearingMeasurement& measured,
                                              const LandmarkAnchor& anchor,
                                              const ViewGeometry& host, const ViewGeometry& target,
                                              const LandmarkParameters& landmark);

/// Weighted residual of the host's own measurement, and its derivative by the landmark.
Eigen::Vector2d hostResidual(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                             const LandmarkParameters& landmark,
                             Eigen::Matrix<double, 2, 3>* J_landmark);

/// bearingResidual() for Ceres, the extrinsic being constant. Parameter blocks: pose of the host
/// (7), pose of the target (7), landmark (3). What it refers to must outlive it. Jacobians by the
/// poses are taken at their first estimates where they have one.
class BearingFactor : public ceres::SizedCostFunction<2, 7, 7, 3> {
 public:
  BearingFactor(const BearingMeasurement& measured, const LandmarkAnchor& anchor, const Pose& T_bc,
                const WindowState& host, const WindowState& target)
      : measured_(measured), anchor_(anchor), T_bc_(T_bc), host_(host), target_(target) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const BearingMeasurement& measured_;
  const LandmarkAnchor& anchor_;
  const Pose& T_bc_;
  const WindowState& host_;
  const WindowState& target_;
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
