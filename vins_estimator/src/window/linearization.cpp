#include "vins_estimator/window/linearization.h"

#include <cmath>

namespace vins {

WindowGeometry geometryOf(const SlidingWindow& window, const std::vector<NavState>& states) {
  WindowGeometry geometry;
  geometry.present.reserve(states.size());
  geometry.linearization.reserve(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Pose& T_wb = states[i].T_wb;
    geometry.present.push_back(viewGeometry(T_wb, window.T_bc));
    geometry.linearization.push_back(
        viewGeometry(window.frames[i].state.poseForJacobians(T_wb), window.T_bc));
  }
  return geometry;
}

WindowGeometry geometryOf(const SlidingWindow& window) {
  std::vector<NavState> states;
  for (const WindowFrame& frame : window.frames) states.push_back(frame.state.value());
  return geometryOf(window, states);
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
  if (host == target) {
    out.r = hostResidual(measured, anchor, landmark, &out.J_landmark);
    out.J_host.setZero();
    out.J_target.setZero();
    return out;
  }
  BearingJacobians J;
  bearingResidual(measured, anchor, geometry.linearization[host], geometry.linearization[target],
                  landmark, &J);
  out.r = observationResidual(measured, anchor, geometry, host, target, landmark);
  out.J_host = J.J_host;
  out.J_target = J.J_target;
  out.J_landmark = J.J_landmark;
  return out;
}

void scaleByLoss(double huber, LinearizedObservation* observation) {
  const double norm = observation->r.norm();
  if (norm <= huber) return;
  const double scale = std::sqrt(huber / norm);
  observation->J_host *= scale;
  observation->J_target *= scale;
  observation->J_landmark *= scale;
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

}  // namespace vins
