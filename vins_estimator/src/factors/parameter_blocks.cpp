#include "vins_estimator/factors/parameter_blocks.h"

#include <Eigen/Geometry>

#include "vins_core/so3.h"

namespace vins::estimator {

using Eigen::Map;
using Eigen::Quaterniond;
using Eigen::Vector3d;

PoseBlock toPoseBlock(const Pose& pose) {
  PoseBlock block;
  Map<Vector3d>(block.data()) = pose.position;
  Map<Quaterniond>(block.data() + 3) = pose.rotation;
  return block;
}

Pose toPose(const double* block) {
  return {Quaterniond(Map<const Quaterniond>(block + 3)), Vector3d(Map<const Vector3d>(block))};
}

MotionBlock toMotionBlock(const NavState& state) {
  MotionBlock block;
  Map<Eigen::Matrix<double, 9, 1>>(block.data()) << state.v_w, state.accelerometer_bias,
      state.gyroscope_bias;
  return block;
}

void setMotion(const double* block, NavState* state) {
  state->v_w = Map<const Vector3d>(block);
  state->accelerometer_bias = Map<const Vector3d>(block + 3);
  state->gyroscope_bias = Map<const Vector3d>(block + 6);
}

NavState toNavState(const double* pose_block, const double* motion_block) {
  NavState state;
  state.T_wb = toPose(pose_block);
  setMotion(motion_block, &state);
  return state;
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Pose pose = toPose(x);
  const Map<const Vector3d> d_position(delta);
  const Vector3d d_rotation = Map<const Vector3d>(delta + 3);
  const PoseBlock moved = toPoseBlock(
      {(pose.rotation * so3::exp(d_rotation)).normalized(), pose.position + d_position});
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double* /*x*/, double* jacobian) const {
  Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
  J.setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Pose to = toPose(y);
  const Pose from = toPose(x);
  Map<Vector3d>{y_minus_x} = to.position - from.position;
  Map<Vector3d>{y_minus_x + 3} = so3::log(from.rotation.conjugate() * to.rotation);
  return true;
}

bool PoseManifold::MinusJacobian(const double* /*x*/, double* jacobian) const {
  Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
  J.setIdentity();
  return true;
}

}  // namespace vins::estimator
