#pragma once

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_estimator/inertial/imu_intrinsics.h"
#include "vins_estimator/visual/bearing_correction.h"

namespace vins::estimator {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

/// What is estimated of a rig besides the motion.
struct RigCalibration {
  Pose T_bc;             ///< camera in the body frame
  double td = 0.0;       ///< t_imu = t_cam + td [s]
  double readout = 0.0;  ///< from the first row to the last, as far as not undone before [s]
  CameraIntrinsics intrinsics = CameraIntrinsics::Zero();  ///< errors of the configured ones
  ImuIntrinsics imu = ImuIntrinsics::Zero();
};

/// Where the errors of a rig's calibration stand in a vector of kRigSize: position [m] and rotation
/// (on the right) [rad] of T_bc, td [s], read-out [s], errors of camera and IMU.
enum RigError { kTimeOffset = 6, kReadout = 7, kIntrinsics = 8, kImuIntrinsics = 14 };
constexpr int kRigSize = 29;
constexpr int kCameraRigSize = 14;  ///< of them, what observations show

/// Which of a rig's errors are variables: extrinsic and td always, the others by group.
struct RigVariables {
  bool camera = false;  ///< read-out and intrinsics
  bool imu = false;     ///< the IMU's intrinsics

  /// Of the variables that observations show, which stand first.
  int cameraSize() const { return camera ? kCameraRigSize : kReadout; }
  int size() const { return cameraSize() + (imu ? kRigSize - kCameraRigSize : 0); }
};

using RigVector = Eigen::Matrix<double, kRigSize, 1>;
using RigMatrix = Eigen::Matrix<double, kRigSize, kRigSize>;
/// Of the variables only.
using RigStep = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kRigSize, 1>;

/// The variables' entries of a vector of all errors.
RigStep selected(const RigVariables& variables, const RigVector& all);
/// The variables' rows and columns.
Eigen::MatrixXd selected(const RigVariables& variables, const RigMatrix& all);
/// A vector and a matrix of all errors, zero where they are no variables.
RigVector expanded(const RigVariables& variables, const RigStep& step);
RigMatrix expanded(const RigVariables& variables, const Eigen::MatrixXd& matrix);

/// calibration [+] d.
RigCalibration plus(const RigCalibration& calibration, const RigVector& d);

/// d with plus(from, d) = to.
RigVector minus(const RigCalibration& to, const RigCalibration& from);

}  // namespace vins::estimator
