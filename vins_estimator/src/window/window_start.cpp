#include "vins_estimator/window/window_start.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vins_estimator/visual/triangulation.h"

namespace vins::estimator {
namespace {

/// The prior on the first state, written about the value it starts with. The rotation's errors are
/// about the world's axes, since yaw and tilt are known differently.
Prior firstPrior(const NavState& first, const NavState& mean, const Vector15d& sigma) {
  Prior prior;
  prior.parts = {{Prior::Kind::kPose, 0, first, {}, {}}, {Prior::Kind::kMotion, 0, first, {}, {}}};
  prior.A = sigma.cwiseInverse().asDiagonal();
  prior.A.block<3, 3>(kRotation, kRotation) *= first.T_wb.rotation.toRotationMatrix();
  prior.b = prior.A * minus(first, mean);
  return prior;
}

/// Adds what is known of the rig: that it is as it stands in the window, with this covariance.
void addRigPrior(const RigCalibration& rig, const RigVariables& variables,
                 const Eigen::MatrixXd& covariance, Prior* prior) {
  const Eigen::Index size = covariance.rows();
  const Eigen::Index rows = prior->A.rows();
  const Eigen::Index columns = prior->A.cols();
  prior->parts.push_back({Prior::Kind::kRig, 0, {}, rig, variables});
  prior->A.conservativeResizeLike(Eigen::MatrixXd::Zero(rows + size, columns + size));
  prior->A.bottomRightCorner(size, size) = covariance.inverse().llt().matrixU();
  prior->b.conservativeResizeLike(Eigen::VectorXd::Zero(rows + size));
}

constexpr std::size_t kViewsWithoutParallax = 3;
constexpr double kFirstInverseDistance = 0.2;  // [1/m], where nothing is known

bool giveDepth(const CameraPoses& cameras, Landmark* track) {
  std::vector<TriangulationView> views;
  for (const TrackObservation& observation : track->observations) {
    views.push_back({cameras.at(observation.frame), observation.measured.bearing,
                     observation.measured.inverse_sigma});
  }
  const Triangulation result = triangulate(views);
  // Tracks without parallax tell rotation all the same; their depth is found when they show some.
  const bool distant = result.status == TriangulationStatus::kLittleParallax &&
                       track->observations.size() >= kViewsWithoutParallax;
  if (!result.ok() && !distant) return false;
  const TrackObservation& host = track->observations.front();
  track->anchor = {host.measured.bearing, host.measured.basis, host.measured.row};
  track->parameters = distant ? Eigen::Vector3d(0.0, 0.0, kFirstInverseDistance) : result.landmark;
  track->has_depth = true;
  return true;
}

}  // namespace

void startWindow(const Initialization& initialization, FrameId first_id, SlidingWindow* window) {
  FrameId id = first_id;
  for (const InitialFrame& initial : initialization.frames) {
    WindowFrame frame{id++, initial.features.stamp, WindowState(initial.state), initial.imu};
    frame.stands_still = initialization.at_rest;
    frame.td = window->rig.td;
    frame.readout = initial.undone_readout;
    frame.measured_rate = initial.measured_rate;
    frame.angular_acceleration = initial.angular_acceleration;
    window->landmarks.addFrame(frame.id, initial.features);
    window->frames.push_back(std::move(frame));
  }
  WindowState& first = window->frames.front().state;
  window->prior = firstPrior(first.value(), initialization.mean, initialization.sigma);
  if (window->refines_rig) {
    addRigPrior(window->rig, window->rig_variables,
                selected(window->rig_variables, window->rig_covariance), &window->prior);
  }
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

}  // namespace vins::estimator
