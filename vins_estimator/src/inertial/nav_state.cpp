#include "vins_estimator/inertial/nav_state.h"

#include "vins_core/so3.h"

namespace vins::estimator {

NavState plus(const NavState& state, const Vector15d& d) {
  NavState moved;
  moved.T_wb.position = state.T_wb.position + d.segment<3>(kPosition);
  moved.T_wb.rotation = (state.T_wb.rotation * so3::exp(d.segment<3>(kRotation))).normalized();
  moved.v_w = state.v_w + d.segment<3>(kVelocity);
  moved.accelerometer_bias = state.accelerometer_bias + d.segment<3>(kAccBias);
  moved.gyroscope_bias = state.gyroscope_bias + d.segment<3>(kGyrBias);
  return moved;
}

Vector15d minus(const NavState& to, const NavState& from) {
  Vector15d d;
  d << to.T_wb.position - from.T_wb.position,
      so3::log(from.T_wb.rotation.conjugate() * to.T_wb.rotation), to.v_w - from.v_w,
      to.accelerometer_bias - from.accelerometer_bias, to.gyroscope_bias - from.gyroscope_bias;
  return d;
}

bool isFinite(const NavState& state) {
  return state.T_wb.position.allFinite() && state.T_wb.rotation.coeffs().allFinite() &&
         state.v_w.allFinite() && state.accelerometer_bias.allFinite() &&
         state.gyroscope_bias.allFinite();
}

void WindowState::fixPose() {
  if (pose_fixed_) return;
  first_estimate_.T_wb = value_.T_wb;
  pose_fixed_ = true;
}

void WindowState::fixMotion() {
  if (motion_fixed_) return;
  first_estimate_.v_w = value_.v_w;
  first_estimate_.accelerometer_bias = value_.accelerometer_bias;
  first_estimate_.gyroscope_bias = value_.gyroscope_bias;
  motion_fixed_ = true;
}

}  // namespace vins::estimator
