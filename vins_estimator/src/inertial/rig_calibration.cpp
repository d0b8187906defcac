#include "vins_estimator/inertial/rig_calibration.h"

#include "vins_core/so3.h"

namespace vins::estimator {

RigCalibration plus(const RigCalibration& calibration, const Vector7d& d) {
  RigCalibration result;
  result.T_bc.position = calibration.T_bc.position + d.head<3>();
  result.T_bc.rotation =
      (calibration.T_bc.rotation * so3::exp(Eigen::Vector3d(d.segment<3>(3)))).normalized();
  result.td = calibration.td + d(6);
  return result;
}

Vector7d minus(const RigCalibration& to, const RigCalibration& from) {
  Vector7d d;
  d << to.T_bc.position - from.T_bc.position,
      so3::log(from.T_bc.rotation.conjugate() * to.T_bc.rotation), to.td - from.td;
  return d;
}

}  // namespace vins::estimator
