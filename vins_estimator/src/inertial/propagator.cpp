#include "vins_estimator/inertial/propagator.h"

#include "vins_core/option_check.h"
#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

constexpr std::size_t kMaxSamples = 20000;  ///< waiting for a state, whatever their stamps say

}  // namespace

void PropagatorOptions::validate() const {
  requireWithin("propagator", "max_horizon", max_horizon, {1e-3, 3600.0});
}

Propagator::Propagator(const ImuNoise& noise, const PropagatorOptions& options)
    : noise_(noise), options_(options) {
  noise_.validate();
  options_.validate();
}

void Propagator::setState(Stamp stamp, const NavState& state, const Matrix15d& covariance) {
  if (!isFinite(state) || !covariance.allFinite()) return;
  if (solved_ && stamp < *solved_) return;
  solved_ = stamp;
  current_ = {stamp, state, Eigen::Vector3d::Zero(), 0.0, covariance, 0.0};
  while (samples_.size() > 1 && samples_[1].stamp <= stamp) samples_.pop_front();
  replay();
}

std::optional<PropagatedState> Propagator::addImu(const ImuSample& sample) {
  if (!sample.isFinite()) return std::nullopt;
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return std::nullopt;
  samples_.push_back(sample);
  period_.add(sample.stamp);
  boundBuffer();
  if (!solved_ || sample.stamp < *solved_) return std::nullopt;
  advanceTo(samples_.size() - 1);
  if (current_.horizon > options_.max_horizon) return std::nullopt;
  return current_;
}

void Propagator::replay() {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (samples_[i].stamp >= *solved_) advanceTo(i);
  }
}

void Propagator::advanceTo(std::size_t index) {
  const ImuSample& to = samples_[index];
  ImuSample from = index > 0 ? samples_[index - 1] : to;
  if (from.stamp < current_.stamp && index > 0) {
    // The solved state lies between two samples.
    const double share = toSeconds(current_.stamp - from.stamp) / toSeconds(to.stamp - from.stamp);
    from.acceleration += share * (to.acceleration - from.acceleration);
    from.angular_velocity += share * (to.angular_velocity - from.angular_velocity);
  }
  step(from, to, toSeconds(to.stamp - current_.stamp));
  current_.stamp = to.stamp;
  current_.horizon = toSeconds(to.stamp - *solved_);
  noteAngularVelocity(to);
}

void Propagator::noteAngularVelocity(const ImuSample& sample) {
  current_.angular_velocity_b = sample.angular_velocity - current_.state.gyroscope_bias;
  const std::optional<double> period = period_.seconds();
  if (period) current_.angular_velocity_variance = noise_.gyroscopeVariance(*period);
}

void Propagator::step(const ImuSample& from, const ImuSample& to, double dt) {
  if (dt <= 0.0) return;
  NavState& state = current_.state;
  const Eigen::Vector3d g_w(0.0, 0.0, -noise_.gravity);
  const Eigen::Vector3d omega_b =
      0.5 * (from.angular_velocity + to.angular_velocity) - state.gyroscope_bias;
  const Eigen::Quaterniond R_from = state.T_wb.rotation;
  const Eigen::Quaterniond turn = so3::exp(omega_b * dt);
  const Eigen::Quaterniond R_to = (R_from * turn).normalized();
  const Eigen::Vector3d f_from = R_from * (from.acceleration - state.accelerometer_bias);
  const Eigen::Vector3d f_to = R_to * (to.acceleration - state.accelerometer_bias);
  const Eigen::Vector3d f_w = 0.5 * (f_from + f_to);
  propagateCovariance(dt, f_w, R_from.toRotationMatrix(), turn.toRotationMatrix());
  const Eigen::Vector3d a_w = f_w + g_w;
  state.T_wb.position += (state.v_w + 0.5 * dt * a_w) * dt;
  state.v_w += a_w * dt;
  state.T_wb.rotation = R_to;
}

void Propagator::propagateCovariance(double dt, const Eigen::Vector3d& f_w,
                                     const Eigen::Matrix3d& R_wb, const Eigen::Matrix3d& turn) {
  // d(R f) = -R f^ dtheta = -(R f)^ R dtheta.
  const Eigen::Matrix3d J_v_theta = -dt * so3::hat(f_w) * R_wb;
  Matrix15d F = Matrix15d::Identity();
  F.block<3, 3>(kPosition, kVelocity).diagonal().setConstant(dt);
  F.block<3, 3>(kPosition, kRotation) = 0.5 * dt * J_v_theta;
  F.block<3, 3>(kPosition, kAccBias) = -0.5 * dt * dt * R_wb;
  F.block<3, 3>(kRotation, kRotation) = turn.transpose();
  F.block<3, 3>(kRotation, kGyrBias).diagonal().setConstant(-dt);
  F.block<3, 3>(kVelocity, kRotation) = J_v_theta;
  F.block<3, 3>(kVelocity, kAccBias) = -dt * R_wb;
  // The step's end is turned by the gyroscope's bias, so half of the step's mean force is.
  F.block<3, 3>(kVelocity, kGyrBias) = -0.5 * dt * J_v_theta;
  F.block<3, 3>(kPosition, kGyrBias) = -0.25 * dt * dt * J_v_theta;
  Matrix15d& P = current_.covariance;
  P = F * P * F.transpose() + stepNoise(dt, F);
}

Matrix15d Propagator::stepNoise(double dt, const Matrix15d& F) const {
  // An error of a step's mean reading acts as the opposite error of the bias does: on the position
  // too, and with what that has in common with the velocity.
  const Eigen::Matrix<double, 9, 3> G_acc = F.block<9, 3>(0, kAccBias);
  const Eigen::Matrix<double, 9, 3> G_gyr = F.block<9, 3>(0, kGyrBias);
  const auto squared = [](double density) { return density * density; };
  Matrix15d Q = Matrix15d::Zero();
  Q.topLeftCorner<9, 9>() = squared(noise_.accelerometer_noise) / dt * G_acc * G_acc.transpose() +
                            squared(noise_.gyroscope_noise) / dt * G_gyr * G_gyr.transpose();
  Q.diagonal().segment<3>(kAccBias).array() += squared(noise_.accelerometer_walk) * dt;
  Q.diagonal().segment<3>(kGyrBias).array() += squared(noise_.gyroscope_walk) * dt;
  return Q;
}

void Propagator::boundBuffer() {
  const Stamp oldest = samples_.back().stamp - toNanoseconds(options_.max_horizon);
  while (samples_.size() > 1 && (samples_.size() > kMaxSamples || samples_[1].stamp < oldest)) {
    samples_.pop_front();
  }
}

void Propagator::reset() {
  samples_.clear();
  period_ = {};
  solved_.reset();
  current_ = {};
}

}  // namespace vins::estimator
