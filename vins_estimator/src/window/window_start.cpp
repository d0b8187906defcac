#include "vins_estimator/window/window_start.h"

#include "vins_estimator/visual/triangulation.h"

namespace vins {
namespace {

/// A prior of independent errors of the first state. Those of the rotation are about the world's
/// axes, since yaw and tilt are known differently.
Prior firstPrior(const NavState& state, const Vector15d& sigma) {
  Prior prior;
  prior.parts = {{0, false, state}, {0, true, state}};
  prior.A = sigma.cwiseInverse().asDiagonal();
  prior.A.block<3, 3>(kRotation, kRotation) *= state.T_wb.rotation.toRotationMatrix();
  prior.b = Eigen::VectorXd::Zero(15);
  return prior;
}

bool giveDepth(const CameraPoses& cameras, Landmark* track) {
  std::vector<TriangulationView> views;
  for (const TrackObservation& observation : track->observations) {
    views.push_back({cameras.at(observation.frame), observation.measured.bearing,
                     observation.measured.inverse_sigma});
  }
  const Triangulation result = triangulate(views);
  if (!result.ok()) return false;
  const TrackObservation& host = track->observations.front();
  track->anchor = {host.measured.bearing, host.measured.basis};
  track->parameters = result.landmark;
  track->has_depth = true;
  return true;
}

}  // namespace

void startWindow(const Initialization& initialization, FrameId first_id, SlidingWindow* window) {
  FrameId id = first_id;
  for (const InitialFrame& initial : initialization.frames) {
    WindowFrame frame{id++, initial.features.stamp, WindowState(initial.state), initial.imu};
    frame.stands_still = initialization.at_rest;
    window->landmarks.addFrame(frame.id, initial.features);
    window->frames.push_back(std::move(frame));
  }
  WindowState& first = window->frames.front().state;
  window->prior = firstPrior(first.value(), initialization.sigma);
  first.fixPose();
  first.fixMotion();
}

int triangulateTracks(SlidingWindow* window) {
  const CameraPoses cameras = window->cameras();
  int count = 0;
  for (auto& [id, track] : window->landmarks.tracks()) {
    if (!track.has_depth && track.observations.size() >= 2) count += giveDepth(cameras, &track);
  }
  return count;
}

}  // namespace vins
