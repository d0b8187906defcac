#include "simulation/trajectory_spline.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

/// Rounding of a time at the very end, in knot intervals.
constexpr double kEndSlack = 1e-6;

}  // namespace

TrajectorySpline::TrajectorySpline(Stamp epoch, double begin_s, double knot_interval_s,
                                   std::vector<Pose> control_poses)
    : epoch_(epoch),
      begin_(begin_s),
      knot_interval_(knot_interval_s),
      control_poses_(std::move(control_poses)) {
  if (control_poses_.size() < kSplineOrder || !(knot_interval_ > 0.0)) {
    throw InputError("spline: found " + std::to_string(control_poses_.size()) + " control poses, " +
                     std::to_string(knot_interval_) +
                     " s apart; allowed: at least 6, apart by more than 0");
  }
  for (std::size_t j = 1; j < control_poses_.size(); ++j) {
    const Pose& before = control_poses_[j - 1];
    const Pose& pose = control_poses_[j];
    steps_.push_back(pose.position - before.position);
    rotations_.push_back(so3::log(before.rotation.conjugate() * pose.rotation));
  }
}

double TrajectorySpline::end() const {
  return begin_ + knot_interval_ * static_cast<double>(control_poses_.size() - kSplineOrder + 1);
}

TrajectorySpline::Place TrajectorySpline::placeAt(double t_s) const {
  const double segments = static_cast<double>(control_poses_.size() - kSplineOrder + 1);
  const double place = (t_s - begin_) / knot_interval_;
  if (!(place >= -kEndSlack && place <= segments + kEndSlack)) {
    std::ostringstream message;
    message << "trajectory: asked for second " << t_s << "; it is known from " << begin_ << " to "
            << end();
    throw InputError(message.str());
  }
  const double segment = std::clamp(std::floor(place), 0.0, segments - 1.0);
  return {static_cast<std::size_t>(segment), quinticWeights(place - segment, knot_interval_)};
}

MotionState TrajectorySpline::at(double t_s) const {
  const Place place = placeAt(t_s);
  MotionState state;
  state.T_wb = control_poses_[place.first];
  Eigen::Vector3d& omega = state.angular_velocity_b;
  Eigen::Vector3d& alpha = state.angular_acceleration_b;
  for (std::size_t j = 0; j < place.weights.value.size(); ++j) {
    const double value = place.weights.value[j];
    const double first = place.weights.first[j];
    const double second = place.weights.second[j];
    const Eigen::Vector3d& step = steps_[place.first + j];
    state.T_wb.position += value * step;
    state.velocity_w += first * step;
    state.acceleration_w += second * step;
    const Eigen::Vector3d& turn = rotations_[place.first + j];
    const Eigen::Quaterniond increment = so3::exp(value * turn);
    state.T_wb.rotation = state.T_wb.rotation * increment;
    omega = increment.conjugate() * omega + first * turn;
    alpha = increment.conjugate() * alpha + first * omega.cross(turn) + second * turn;
  }
  state.T_wb.rotation.normalize();
  return state;
}

Pose TrajectorySpline::poseAt(double t_s) const { return at(t_s).T_wb; }

TrajectorySpline TrajectorySpline::shiftedBy(Stamp delay) const {
  TrajectorySpline shifted = *this;
  shifted.epoch_ += delay;
  return shifted;
}

}  // namespace vins::simulation
