#include "vins_estimator/health/continuation.h"

#include <algorithm>
#include <cmath>

#include "vins_core/heading.h"
#include "vins_estimator/inertial/preintegration.h"

namespace vins::estimator {
namespace {

constexpr double kLongestCarry = 1.0;    // [s]: then accelerations can no longer be trusted
constexpr double kUnknownSpeed = 1.0;    // [m/s], of a body that was lost
constexpr double kUnknownTurn = 0.02;    // [rad/s], of a gyroscope that is in doubt
constexpr double kUnseenTurn = 0.5;      // [rad/s], while it was silent
constexpr double kLongestMemory = 10.0;  // [s]; first frames are younger

/// Deviation of a turn about the vertical, by the covariance of a rotation's error in the body.
double yawSigma(const Eigen::Quaterniond& R_wb, const Matrix15d& covariance) {
  const Eigen::Vector3d up_b = R_wb.conjugate() * Eigen::Vector3d::UnitZ();
  return std::sqrt(up_b.dot(covariance.block<3, 3>(kRotation, kRotation) * up_b));
}

NavState moved(const Eigen::Quaterniond& turn, const Eigen::Vector3d& shift,
               const NavState& state) {
  NavState result = state;
  result.T_wb.rotation = (turn * state.T_wb.rotation).normalized();
  result.T_wb.position = turn * state.T_wb.position + shift;
  result.v_w = turn * state.v_w;
  return result;
}

/// Moves all states by the yaw and the shift that take one state to another.
void moveAll(const NavState& from, const NavState& to, Initialization* initialization) {
  const Eigen::Quaterniond turn =
      yawRotation(yawOf(to.T_wb.rotation * from.T_wb.rotation.conjugate()));
  const Eigen::Vector3d shift = to.T_wb.position - turn * from.T_wb.position;
  for (InitialFrame& frame : initialization->frames) frame.state = moved(turn, shift, frame.state);
  initialization->mean = moved(turn, shift, initialization->mean);
}

void addDoubt(double position_sigma, double yaw_sigma, Initialization* initialization) {
  auto& sigma = initialization->sigma;
  sigma.segment<3>(kPosition).setConstant(std::hypot(sigma(kPosition), position_sigma));
  sigma(kRotation + 2) = std::hypot(sigma(kRotation + 2), yaw_sigma);
}

}  // namespace

void Continuation::start(Stamp stamp, const NavState& state, const Matrix15d& covariance) {
  const Eigen::Vector3d position = covariance.diagonal().head<3>();
  entries_ = {
      {stamp, state, std::sqrt(position.maxCoeff()), yawSigma(state.T_wb.rotation, covariance)}};
  carried_ = 0.0;
}

void Continuation::addFrame(const FrameMeasurements& measurements) {
  if (!isActive() || measurements.imu.size() < 2) return;
  Entry entry = entries_.back();
  const double dt = toSeconds(measurements.frame.stamp - entry.stamp);
  if (dt <= 0.0) return;
  Preintegration imu(noise_, entry.state.accelerometer_bias, entry.state.gyroscope_bias);
  imu.integrate(measurements.imu);
  NavState next = imu.predict(entry.state, {0.0, 0.0, -noise_.gravity});
  carried_ += dt;
  if (carried_ > kLongestCarry || measurements.has_gap) {
    next.T_wb.position = entry.state.T_wb.position;
    next.v_w.setZero();
  }
  entry.position_sigma += dt * kUnknownSpeed;
  const double turn_rate = measurements.has_gap ? kUnseenTurn : kUnknownTurn;
  entry.yaw_sigma += dt * turn_rate + yawSigma(next.T_wb.rotation, imu.covariance());
  entry.stamp = measurements.frame.stamp;
  entry.state = next;
  entries_.push_back(entry);
  while (toSeconds(entries_.back().stamp - entries_.front().stamp) > kLongestMemory) {
    entries_.pop_front();
  }
}

/// The entry nearest in time.
const Continuation::Entry& Continuation::at(Stamp stamp) const {
  return *std::min_element(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) {
    return std::abs(a.stamp - stamp) < std::abs(b.stamp - stamp);
  });
}

void Continuation::apply(Initialization* initialization) const {
  if (!isActive() || initialization->frames.empty()) return;
  const NavState first = initialization->frames.front().state;
  const Entry& last = at(initialization->frames.front().features.stamp);
  moveAll(first, last.state, initialization);
  addDoubt(last.position_sigma, last.yaw_sigma, initialization);
}

void moveNewestTo(const NavState& newest, const Matrix15d& covariance, double share,
                  Initialization* initialization) {
  if (initialization->frames.empty()) return;
  moveAll(NavState(initialization->frames.back().state), newest, initialization);
  const double rest = std::sqrt(std::max(0.0, 1.0 - share));
  const double position_sigma = std::sqrt(covariance.diagonal().head<3>().maxCoeff());
  addDoubt(rest * position_sigma, rest * yawSigma(newest.T_wb.rotation, covariance),
           initialization);
}

}  // namespace vins::estimator
