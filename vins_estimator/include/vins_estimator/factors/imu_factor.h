#pragma once

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"

namespace vins::estimator {

using Matrix15x6d = Eigen::Matrix<double, 15, 6>;
using Matrix15x9d = Eigen::Matrix<double, 15, 9>;

/// Residual of two states i and j against the preintegrated IMU between them (VINS-Mono, equation
/// 16): alpha, rotation, beta, accelerometer bias, gyroscope bias, not weighted.
Vector15d imuResidual(const Preintegration& imu, const Eigen::Vector3d& g_w, const NavState& i,
                      const NavState& j);
/// The same with these errors of the IMU's axes in place of those integrated with.
Vector15d imuResidual(const Preintegration& imu, const Eigen::Vector3d& g_w, const NavState& i,
                      const NavState& j, const ImuIntrinsics& intrinsics);

/// Derivatives of imuResidual() by the error states of pose (position, rotation) and motion
/// (velocity, accelerometer bias, gyroscope bias) at i and at j.
struct ImuJacobians {
  Matrix15x6d J_pose_i;
  Matrix15x9d J_motion_i;
  Matrix15x6d J_pose_j;
  Matrix15x9d J_motion_j;
  Matrix15d J_intrinsics;  ///< by the errors of the IMU's axes
};
ImuJacobians imuJacobians(const Preintegration& imu, const Eigen::Vector3d& g_w, const NavState& i,
                          const NavState& j);
ImuJacobians imuJacobians(const Preintegration& imu, const Eigen::Vector3d& g_w, const NavState& i,
                          const NavState& j, const ImuIntrinsics& intrinsics);

/// imuResidual() and its derivatives, weighted.
struct WeightedImuRows {
  Eigen::Matrix<double, 15, 30> J;  ///< by motions i and j, then poses i and j
  Matrix15d J_intrinsics;           ///< by the errors of the IMU's axes
  Vector15d r;
};
/// Takes the residual at `i` and `j`, the derivatives at `linearized_i` and `linearized_j`, with
/// these errors of the IMU's axes.
WeightedImuRows weightedImuRows(const Preintegration& imu, const Eigen::Vector3d& g_w,
                                const NavState& i, const NavState& j, const NavState& linearized_i,
                                const NavState& linearized_j, const ImuIntrinsics& intrinsics);

/// Covariance, by ErrorState, of the state that the IMU predicts from state i, whose errors have
/// `covariance`.
Matrix15d carriedCovariance(const Preintegration& imu, const Eigen::Vector3d& g_w,
                            const NavState& i, const Matrix15d& covariance);

/// The weighted residual for Ceres. Parameter blocks: pose i (7), motion i (9), pose j, motion j,
/// as in parameter_blocks.h. What it refers to must outlive it. Jacobians are taken at the states'
/// first estimates where they have one.
class ImuFactor : public ceres::SizedCostFunction<15, 7, 9, 7, 9> {
 public:
  ImuFactor(const Preintegration& imu, const Eigen::Vector3d& g_w, const WindowState& i,
            const WindowState& j)
      : ImuFactor(imu, g_w, i, j, imu.intrinsics()) {}
  /// With these errors of the IMU's axes.
  ImuFactor(const Preintegration& imu, const Eigen::Vector3d& g_w, const WindowState& i,
            const WindowState& j, const ImuIntrinsics& intrinsics)
      : imu_(imu), g_w_(g_w), i_(i), j_(j), intrinsics_(intrinsics) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const Preintegration& imu_;
  Eigen::Vector3d g_w_;
  const WindowState& i_;
  const WindowState& j_;
  ImuIntrinsics intrinsics_;
};

}  // namespace vins::estimator
