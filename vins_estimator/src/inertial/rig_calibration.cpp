#include "vins_estimator/inertial/rig_calibration.h"

#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

constexpr int kImuSize = kRigSize - kCameraRigSize;

}  // namespace

RigStep selected(const RigVariables& variables, const RigVector& all) {
  RigStep step(variables.size());
  step.head(variables.cameraSize()) = all.head(variables.cameraSize());
  if (variables.imu) step.tail<kImuSize>() = all.tail<kImuSize>();
  return step;
}

Eigen::MatrixXd selected(const RigVariables& variables, const RigMatrix& all) {
  Eigen::MatrixXd some(variables.size(), variables.size());
  for (int i = 0; i < kRigSize; ++i) {
    const RigStep column = selected(variables, RigVector(all.col(i)));
    if (i < variables.cameraSize()) some.col(i) = column;
    if (variables.imu && i >= kCameraRigSize) {
      some.col(variables.cameraSize() + i - kCameraRigSize) = column;
    }
  }
  return some;
}

RigVector expanded(const RigVariables& variables, const RigStep& step) {
  RigVector all = RigVector::Zero();
  all.head(variables.cameraSize()) = step.head(variables.cameraSize());
  if (variables.imu) all.tail<kImuSize>() = step.tail<kImuSize>();
  return all;
}

RigMatrix expanded(const RigVariables& variables, const Eigen::MatrixXd& matrix) {
  RigMatrix all = RigMatrix::Zero();
  const int camera = variables.cameraSize();
  all.topLeftCorner(camera, camera) = matrix.topLeftCorner(camera, camera);
  if (!variables.imu) return all;
  all.bottomRightCorner<kImuSize, kImuSize>() = matrix.bottomRightCorner<kImuSize, kImuSize>();
  all.block(0, kCameraRigSize, camera, kImuSize) = matrix.topRightCorner(camera, kImuSize);
  all.block(kCameraRigSize, 0, kImuSize, camera) = matrix.bottomLeftCorner(kImuSize, camera);
  return all;
}

RigCalibration plus(const RigCalibration& calibration, const RigVector& d) {
  RigCalibration result;
  result.T_bc.position = calibration.T_bc.position + d.head<3>();
  result.T_bc.rotation =
      (calibration.T_bc.rotation * so3::exp(Eigen::Vector3d(d.segment<3>(3)))).normalized();
  result.td = calibration.td + d(kTimeOffset);
  result.readout = calibration.readout + d(kReadout);
  result.intrinsics = calibration.intrinsics + d.segment<6>(kIntrinsics);
  result.imu = calibration.imu + d.tail<kImuSize>();
  return result;
}

RigVector minus(const RigCalibration& to, const RigCalibration& from) {
  RigVector d;
  d << to.T_bc.position - from.T_bc.position,
      so3::log(from.T_bc.rotation.conjugate() * to.T_bc.rotation), to.td - from.td,
      to.readout - from.readout, to.intrinsics - from.intrinsics, to.imu - from.imu;
  return d;
}

}  // namespace vins::estimator
