#include "vins_estimator/window/sliding_window.h"

#include <algorithm>

#include "vins_core/so3.h"

namespace vins::estimator {

Pose carried(const Pose& T_wb, const Eigen::Matrix<double, 6, 1>& rate, double late) {
  if (late == 0.0) return T_wb;
  return {T_wb.rotation * so3::exp(Eigen::Vector3d(late * rate.tail<3>())),
          T_wb.position + late * rate.head<3>()};
}

Eigen::Matrix<double, 6, 1> bodyRate(const WindowFrame& frame, const NavState& state, double late) {
  Eigen::Matrix<double, 6, 1> rate;
  rate << state.v_w,
      frame.measured_rate + 0.5 * late * frame.angular_acceleration - state.gyroscope_bias;
  return rate;
}

NavState SlidingWindow::atImage(const WindowFrame& frame) const {
  NavState state = frame.state.value();
  const double late = rig.td - frame.td;
  state.T_wb = carried(state.T_wb, bodyRate(frame, state, late), late);
  return state;
}

WindowValues SlidingWindow::values() const {
  WindowValues values;
  values.states.reserve(frames.size());
  for (const WindowFrame& frame : frames) values.states.push_back(frame.state.value());
  if (loop) values.old.push_back(loop->T_wb);
  values.rig = rig;
  return values;
}

std::size_t SlidingWindow::indexOf(FrameId id) const {
  const auto it =
      std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.id == id; });
  return static_cast<std::size_t>(it - frames.begin());
}

CameraPoses SlidingWindow::cameras() const {
  CameraPoses cameras;
  for (const WindowFrame& frame : frames) {
    cameras.emplace_hint(cameras.end(), frame.id, atImage(frame).T_wb * rig.T_bc);
  }
  return cameras;
}

void dropFrame(SlidingWindow* window, std::size_t index) {
  auto& frames = window->frames;
  window->landmarks.removeFrame(frames[index].id, window->cameras());
  if (index + 1 < frames.size()) {
    Preintegration joined = std::move(frames[index].imu);
    joined.append(frames[index + 1].imu);
    frames[index + 1].imu = std::move(joined);
    frames[index + 1].has_rested = frames[index + 1].has_rested && frames[index].has_rested;
  }
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(index));
  for (Prior::Part& part : window->prior.parts) {
    if (part.kind != Prior::Kind::kRig && part.frame > index) --part.frame;
  }
}

}  // namespace vins::estimator
