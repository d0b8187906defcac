#include "vins_estimator/window/linearization.h"

#include <cmath>

#include "vins_core/so3.h"

namespace vins::estimator {

namespace {

/// Adds how the frame's camera moves, and its errors as far as they were not undone before.
void addCamera(const RigCalibration& rig, const Eigen::Matrix<double, 6, 1>& rate,
               const WindowFrame& frame, ViewGeometry* view) {
  const Eigen::Vector3d w_b = rate.tail<3>();
  view->w_c = rig.T_bc.rotation.conjugate() * w_b;
  view->v_c = view->R_wc.transpose() *
              (rate.head<3>() + view->R_wb * Eigen::Vector3d(w_b.cross(rig.T_bc.position)));
  view->a_c = rig.T_bc.rotation.conjugate() * frame.angular_acceleration;
  view->readout = rig.readout - frame.readout;
  view->intrinsics = rig.intrinsics;
}

/// Jacobians by the read-out and by the camera's intrinsics.
void addCameraJacobians(const BearingMeasurement& measured, const LandmarkAnchor& anchor,
                        const ViewGeometry& host, const ViewGeometry& target,
                        const LandmarkParameters& landmark, LinearizedObservation* out) {
  out->J_rig.col(kReadout) = readoutJacobian(measured, anchor, host, target, landmark);
  out->J_rig.rightCols<6>() = intrinsicsJacobian(measured, anchor, host, target, landmark);
}

}  // namespace

WindowGeometry geometryOf(const SlidingWindow& window, const WindowValues& values) {
  WindowGeometry geometry;
  const std::size_t views = values.states.size() + values.old.size();
  geometry.present.reserve(views);
  geometry.linearization.reserve(views);
  const Pose& T_bc = values.rig.T_bc;
  geometry.shows_camera = window.refines_rig && window.rig_variables.camera;
  for (std::size_t i = 0; i < values.states.size(); ++i) {
    const NavState& state = values.states[i];
    const WindowFrame& frame = window.frames[i];
    const double late = values.rig.td - frame.td;
    const Eigen::Matrix<double, 6, 1> rate = bodyRate(frame, state, late);
    geometry.present.push_back(viewGeometry(carried(state.T_wb, rate, late), T_bc));
    geometry.linearization.push_back(
        viewGeometry(carried(frame.state.poseForJacobians(state.T_wb), rate, late), T_bc));
    if (geometry.shows_camera) {
      addCamera(values.rig, rate, frame, &geometry.present.back());
      addCamera(values.rig, rate, frame, &geometry.linearization.back());
    }
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
  if (host == target) {
    return hostResidual(measured, anchor, geometry.present[host], landmark, nullptr);
  }
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
    hostResidual(measured, anchor, geometry.linearization[host], landmark, &out.J_landmark);
    if (geometry.shows_camera && geometry.shows_rig[host]) {
      out.J_rig.rightCols<6>() = hostIntrinsicsJacobian(measured, anchor, landmark);
    }
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
    out.J_rig.col(kTimeOffset) =
        J.J_host * geometry.td_rates[host] + J.J_target * geometry.td_rates[target];
    if (geometry.shows_camera) {
      addCameraJacobians(measured, anchor, geometry.linearization[host],
                         geometry.linearization[target], landmark, &out);
    }
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
