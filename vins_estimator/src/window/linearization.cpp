#include "vins_estimator/window/linearization.h"

#include <cmath>

#include "vins_core/so3.h"

namespace vins::estimator {

namespace {

/// Where a frame's body was `late` seconds after the frame's time.
Pose carried(const Pose& T_wb, const Eigen::Matrix<double, 6, 1>& rate, double late) {
  if (late == 0.0) return T_wb;
  return {T_wb.rotation * so3::exp(Eigen::Vector3d(late * rate.tail<3>())),
          T_wb.position + late * rate.head<3>()};
}

}  // namespace

WindowGeometry geometryOf(const SlidingWindow& window, const WindowValues& values) {
  WindowGeometry geometry;
  const std::size_t views = values.states.size() + values.old.size();
  geometry.present.reserve(views);
  geometry.linearization.reserve(views);
  const Pose& T_bc = values.rig.T_bc;
  for (std::size_t i = 0; i < values.states.size(); ++i) {
    const NavState& state = values.states[i];
    const WindowFrame& frame = window.frames[i];
    Eigen::Matrix<double, 6, 1> rate;
    rate << state.v_w, frame.measured_rate - state.gyroscope_bias;
    const double late = values.rig.td - frame.td;
    geometry.present.push_back(viewGeometry(carried(state.T_wb, rate, late), T_bc));
    geometry.linearization.push_back(
        viewGeometry(carried(frame.state.poseForJacobians(state.T_wb), rate, late), T_bc));
    geometry.td_rates.push_back(rate);
    geometry.shows_rig.push_back(window.refines_rig && !frame.stands_still);
  }
  for (const Pose& T_wb : values.old) {
    geometry.present.push_back(viewGeometry(T_wb, T_bc));
    geometry.linearization.push_back(geometry.present.back());
    geometry.td_rates.emplace_back(Eigen::Matrix<double, 6, 1>::Zero());
    geometry.shows_rig.push_back(window.refines_rig);
  }
  return geometry;
}

Eigen::Vector2d observationResidual(const BearingMeasurement& measured,
                                    const LandmarkAnchor& anchor, const WindowGeometry& geometry,
                                    std::size_t host, std::size_t target,
                                    const LandmarkParameters& landmark) {
  if (host == target) return hostResidual(measured, anchor, landmark, nullptr);
  return bearingResidual(measured, anchor, geometry.present[host], geometry.present[target],
                         landmark, nullptr);
}

LinearizedObservation linearizeObservation(const BearingMeasurement& measured,
                                           const LandmarkAnchor& anchor,
                                           const WindowGeometry& geometry, std::size_t host,
                                           std::size_t target, const LandmarkParameters& landmark) {
  LinearizedObservation out;
  out.target = target;
  out.r = observationResidual(measured, anchor, geometry, host, target, landmark);
  out.J_rig.setZero();
  if (host == target) {
    hostResidual(measured, anchor, landmark, &out.J_landmark);
    out.J_host.setZero();
    out.J_target.setZero();
    return out;
  }
  BearingJacobians J;
  bearingResidual(measured, anchor, geometry.linearization[host], geometry.linearization[target],
                  landmark, &J);
  out.J_host = J.J_host;
  out.J_target = J.J_target;
  out.J_landmark = J.J_landmark;
  if (geometry.shows_rig[target]) {
    out.J_rig.leftCols<6>() = extrinsicJacobian(measured, anchor, geometry.linearization[host],
                                                geometry.linearization[target], landmark);
    out.J_rig.col(6) = J.J_host * geometry.td_rates[host] + J.J_target * geometry.td_rates[target];
  }
  return out;
}

void scaleByLoss(double huber, LinearizedObservation* observation) {
  const double norm = observation->r.norm();
  if (norm <= huber) return;
  const double scale = std::sqrt(huber / norm);
  observation->J_host *= scale;
  observation->J_target *= scale;
  observation->J_landmark *= scale;
  observation->J_rig *= scale;
  observation->r *= scale;
}

LinearizedLandmark linearize(const SlidingWindow& window, const WindowGeometry& geometry,
                             const Landmark& landmark, double huber) {
  LinearizedLandmark result;
  result.host = window.indexOf(landmark.host());
  for (const TrackObservation& observation : landmark.observations) {
    result.observations.push_back(
        linearizeObservation(observation.measured, landmark.anchor, geometry, result.host,
                             window.indexOf(observation.frame), landmark.parameters));
    scaleByLoss(huber, &result.observations.back());
  }
  return result;
}

Eigen::Matrix<double, 6, 1> poseShift(const WindowState& state) {
  if (!state.isPoseFixed()) return Eigen::Matrix<double, 6, 1>::Zero();
  return minus(state.value(), state.firstEstimate()).head<6>();
}

Eigen::Matrix<double, 9, 1> motionShift(const WindowState& state) {
  if (!state.isMotionFixed()) return Eigen::Matrix<double, 9, 1>::Zero();
  return minus(state.value(), state.firstEstimate()).tail<9>();
}

}  // namespace vins::estimator
