#include "vins_estimator/inertial/preintegration.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One midpoint step of the increments and what its derivatives need.
struct Midpoint {
  double dt;
  Matrix3d R_from;  ///< gamma before the step
  Matrix3d R_to;    ///< and after it
  Matrix3d turn;    ///< rotation of the step
  Matrix3d J_r;     ///< right Jacobian of the step's rotation vector
  Vector3d a_from;  ///< true specific forces
  Vector3d a_to;
  Matrix3d gain_a;  ///< of the sensors' axes
  Matrix3d gain_w;
};

/// d(error after) / d(error before), first order in the errors and exact in the step. The biases
/// are taken as constant over the step.
Matrix15d transition(const Midpoint& m) {
  const double half = 0.5 * m.dt;
  // The velocity's error by the rotation's: the second reading is turned by the new rotation.
  const Matrix3d J_v_theta =
      -half * (m.R_from * so3::hat(m.a_from) + m.R_to * so3::hat(m.a_to) * m.turn.transpose());
  const Matrix3d J_v_bg = half * m.R_to * so3::hat(m.a_to) * m.J_r * m.dt * m.gain_w;
  const Matrix3d J_v_ba = -half * (m.R_from + m.R_to) * m.gain_a;
  Matrix15d F = Matrix15d::Identity();
  F.block<3, 3>(kPosition, kRotation) = half * J_v_theta;
  F.block<3, 3>(kPosition, kVelocity) = m.dt * Matrix3d::Identity();
  F.block<3, 3>(kPosition, kAccBias) = half * J_v_ba;
  F.block<3, 3>(kPosition, kGyrBias) = half * J_v_bg;
  F.block<3, 3>(kRotation, kRotation) = m.turn.transpose();
  F.block<3, 3>(kRotation, kGyrBias) = -m.J_r * m.dt * m.gain_w;
  F.block<3, 3>(kVelocity, kRotation) = J_v_theta;
  F.block<3, 3>(kVelocity, kAccBias) = J_v_ba;
  F.block<3, 3>(kVelocity, kGyrBias) = J_v_bg;
  return F;
}

/// Readings of a step without their biases.
struct Readings {
  Vector3d a_from;
  Vector3d a_to;
  Vector3d w;  ///< mean
};

/// d(alpha, theta, beta after the step) by the errors of the axes, as far as the step makes them.
Eigen::Matrix<double, 9, 15> intrinsicsStep(const Midpoint& m, const Readings& r) {
  const double half = 0.5 * m.dt;
  constexpr int kAcc = kAccelerometerIntrinsics;
  Eigen::Matrix<double, 9, 15> J = Eigen::Matrix<double, 9, 15>::Zero();
  J.block<3, kAcc>(kVelocity, 0) = half * (m.R_from * accelerometerGainJacobian(r.a_from) +
                                           m.R_to * accelerometerGainJacobian(r.a_to));
  const Eigen::Matrix<double, 3, 9> J_turn = m.dt * m.J_r * gyroscopeGainJacobian(r.w);
  J.block<3, 9>(kRotation, kAcc) = J_turn;
  J.block<3, 9>(kVelocity, kAcc) = -half * m.R_to * so3::hat(m.a_to) * J_turn;
  J.middleRows<3>(kPosition) = half * J.middleRows<3>(kVelocity);
  return J;
}

/// Motion of a deviation s at a frequency f, drawn as a straight line over dt, is missed by
/// s (2 pi f dt)^2 / 8 until that reaches s itself: next to nothing at the usual rates, it is what
/// a gap in the samples costs. One error for the whole of dt is written as independent ones of its
/// steps.
Preintegration::MissedMotion missedMotion(double dt, int steps) {
  constexpr double kFrequency = 1.5;     // [Hz], of a vehicle's or a hand's motion
  constexpr double kAcceleration = 2.0;  // deviation [m/s^2]
  constexpr double kTurnRate = 0.5;      // deviation [rad/s]
  const double phase = 2.0 * M_PI * kFrequency * dt;
  const double share = std::min(1.0, phase * phase / 8.0);
  return {steps * std::pow(share * kAcceleration, 2), steps * std::pow(share * kTurnRate, 2)};
}

/// What the noise of one step adds. White noise of density s acts as one error of variance
/// s^2 / dt, constant over the step: the sum over many steps then has the variance s^2 t that the
/// density says. (Two half-errors, one a reading, would be counted as independent in neighbouring
/// steps, which share a reading, and halve it.) Within the step the noise is white as well, which
/// leaves the position an error of variance s^2 dt^3 / 12 that the velocity does not share (the
/// integral of a Wiener process about its mean slope): without it the covariance of an interval of
/// one step is singular.
Matrix15d stepNoise(const Midpoint& m, const ImuNoise& noise,
                    const Preintegration::MissedMotion& missed, const Matrix15d& F) {
  const double acc =
      noise.accelerometer_noise * noise.accelerometer_noise / m.dt + missed.acceleration;
  const double gyr = noise.gyroscope_noise * noise.gyroscope_noise / m.dt + missed.turn_rate;
  // An error of a reading acts as the opposite error of the bias does.
  const Eigen::Matrix<double, 9, 3> G_acc = F.block<9, 3>(0, kAccBias);
  const Eigen::Matrix<double, 9, 3> G_gyr = F.block<9, 3>(0, kGyrBias);
  Matrix15d Q = Matrix15d::Zero();
  Q.topLeftCorner<9, 9>() = acc * G_acc * G_acc.transpose() + gyr * G_gyr * G_gyr.transpose();
  Q.diagonal().segment<3>(kPosition).array() += acc * std::pow(m.dt, 4) / 12.0;
  const double acc_walk = noise.accelerometer_walk * noise.accelerometer_walk * m.dt;
  const double gyr_walk = noise.gyroscope_walk * noise.gyroscope_walk * m.dt;
  Q.diagonal().segment<3>(kAccBias).array() += acc_walk;
  Q.diagonal().segment<3>(kGyrBias).array() += gyr_walk;
  return Q;
}

/// Variance of single readings, by their second differences, in which motion is nearly nil: those
/// of white noise of variance v have the variance 6 v. The axis that is shaken most counts.
double readingVariance(const std::vector<ImuSample>& samples) {
  if (samples.size() < 3) return 0.0;
  Vector3d squares = Vector3d::Zero();
  for (std::size_t i = 2; i < samples.size(); ++i) {
    squares +=
        (samples[i].acceleration - 2.0 * samples[i - 1].acceleration + samples[i - 2].acceleration)
            .cwiseAbs2();
  }
  return squares.maxCoeff() / (6.0 * static_cast<double>(samples.size() - 2));
}

/// Least density of an accelerometer at rest [m/s^2/sqrt(Hz)]: a minute tells gravity to 0.04
/// degrees.
constexpr double kAtRest = 0.05;

/// Least deviations of an interval's increments, below those of a usual camera period. Intervals
/// far shorter than an IMU period would otherwise weigh so much that the solution loses its digits.
Vector15d leastDeviations() {
  Vector15d sigma;
  sigma.segment<3>(kPosition).setConstant(1e-6);  // [m]
  sigma.segment<3>(kRotation).setConstant(3e-7);  // [rad]
  sigma.segment<3>(kVelocity).setConstant(1e-6);  // [m/s]
  sigma.segment<3>(kAccBias).setConstant(1e-6);   // [m/s^2]
  sigma.segment<3>(kGyrBias).setConstant(3e-7);   // [rad/s]
  return sigma;
}

/// The noise of a piece: raised by what of its vibration does not average out.
ImuNoise noiseOf(const ImuNoise& usual, const std::vector<ImuSample>& samples) {
  ImuNoise noise = usual;
  const double span = toSeconds(samples.back().stamp - samples.front().stamp);
  const double period = span / static_cast<double>(samples.size() - 1);
  const double white = noise.accelerometer_noise * noise.accelerometer_noise;
  const double excess = std::max(0.0, readingVariance(samples) * period - white);
  noise.accelerometer_noise =
      std::sqrt(white + usual.vibration_share * usual.vibration_share * excess);
  return noise;
}

}  // namespace

Preintegration::Preintegration(const ImuNoise& noise, const Vector3d& accelerometer_bias,
                               const Vector3d& gyroscope_bias, const ImuIntrinsics& intrinsics)
    : noise_(noise),
      accelerometer_bias_(accelerometer_bias),
      gyroscope_bias_(gyroscope_bias),
      intrinsics_(intrinsics) {}

void Preintegration::integrate(const std::vector<ImuSample>& samples, bool at_rest) {
  if (samples.size() < 2) return;
  pieces_.push_back({samples, at_rest});
  integratePiece(pieces_.back());
}

void Preintegration::append(const Preintegration& next) {
  for (const Piece& piece : next.pieces_) integrate(piece.samples, piece.at_rest);
}

void Preintegration::reintegrate(const Vector3d& accelerometer_bias,
                                 const Vector3d& gyroscope_bias) {
  reintegrate(accelerometer_bias, gyroscope_bias, ImuIntrinsics(intrinsics_));
}

void Preintegration::reintegrate(const Vector3d& accelerometer_bias, const Vector3d& gyroscope_bias,
                                 const ImuIntrinsics& intrinsics) {
  accelerometer_bias_ = accelerometer_bias;
  gyroscope_bias_ = gyroscope_bias;
  intrinsics_ = intrinsics;
  duration_ = 0.0;
  alpha_.setZero();
  gamma_.setIdentity();
  beta_.setZero();
  jacobian_.setIdentity();
  intrinsics_jacobian_.setZero();
  covariance_.setZero();
  sqrt_information_known_ = false;
  for (const Piece& piece : pieces_) integratePiece(piece);
}

void Preintegration::integratePiece(const Piece& piece) {
  const std::vector<ImuSample>& samples = piece.samples;
  ImuNoise noise = noiseOf(noise_, samples);
  if (piece.at_rest) noise.accelerometer_noise = std::max(noise.accelerometer_noise, kAtRest);
  for (std::size_t i = 1; i < samples.size(); ++i) bridge(samples[i - 1], samples[i], noise);
  sqrt_information_known_ = false;
}

void Preintegration::bridge(const ImuSample& from, const ImuSample& to, const ImuNoise& noise) {
  // In one long step the errors of alpha and beta would be the same, and their covariance singular.
  constexpr double kLongestStep = 0.01;  // [s]
  const double dt = toSeconds(to.stamp - from.stamp);
  if (dt <= 0.0) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kLongestStep - 1e-6)));
  const MissedMotion missed = missedMotion(dt, steps);
  ImuSample last = from;
  for (int k = 1; k <= steps; ++k) {
    const Stamp stamp = from.stamp + toNanoseconds(dt * k / steps);
    const ImuSample next = k < steps ? interpolate(from, to, stamp) : to;
    step(last, next, noise, missed);
    last = next;
  }
}

void Preintegration::step(const ImuSample& from, const ImuSample& to, const ImuNoise& noise,
                          const MissedMotion& missed) {
  const double dt = toSeconds(to.stamp - from.stamp);
  const Readings readings{from.acceleration - accelerometer_bias_,
                          to.acceleration - accelerometer_bias_,
                          0.5 * (from.angular_velocity + to.angular_velocity) - gyroscope_bias_};
  const Matrix3d gain_a = accelerometerGain(intrinsics_);
  const Matrix3d gain_w = gyroscopeGain(intrinsics_);
  const Vector3d phi = dt * (gain_w * readings.w);
  const Eigen::Quaterniond turn = so3::exp(phi);
  const Eigen::Quaterniond gamma = (gamma_ * turn).normalized();
  const Midpoint m{dt,
                   gamma_.toRotationMatrix(),
                   gamma.toRotationMatrix(),
                   turn.toRotationMatrix(),
                   so3::rightJacobian(phi),
                   gain_a * readings.a_from,
                   gain_a * readings.a_to,
                   gain_a,
                   gain_w};
  const Vector3d a = 0.5 * (m.R_from * m.a_from + m.R_to * m.a_to);
  alpha_ += dt * beta_ + 0.5 * dt * dt * a;
  beta_ += dt * a;
  gamma_ = gamma;
  duration_ += dt;
  const Matrix15d F = transition(m);
  jacobian_ = F * jacobian_;
  intrinsics_jacobian_ =
      F.topLeftCorner<9, 9>() * intrinsics_jacobian_ + intrinsicsStep(m, readings);
  covariance_ = F * covariance_ * F.transpose() + stepNoise(m, noise, missed, F);
}

bool Preintegration::needsReintegration(const Vector3d& accelerometer_bias,
                                        const Vector3d& gyroscope_bias,
                                        const ImuIntrinsics& intrinsics) const {
  // What first order leaves out is of the size of the angle that the gyroscope bias turned by,
  // squared, and of its product with the velocity that the accelerometer bias made.
  constexpr double kAngle = 2e-3;  // [rad]: squared, 4e-6 rad, far below any gyroscope's noise
  constexpr double kSpeed = 0.05;  // [m/s]: times such an angle, 0.1 mm/s
  const double angle = Eigen::AngleAxisd(gamma_).angle();
  const ImuIntrinsics d = intrinsics - intrinsics_;
  return (gyroscope_bias - gyroscope_bias_).norm() * duration_ > kAngle ||
         (accelerometer_bias - accelerometer_bias_).norm() * duration_ > kSpeed ||
         d.tail<9>().norm() * angle > kAngle || d.head<6>().norm() * beta_.norm() > kSpeed;
}

bool Preintegration::isWeightable() const {
  if (!sqrt_information_known_) computeSqrtInformation();
  return is_weightable_;
}

const Matrix15d& Preintegration::sqrtInformation() const {
  if (!sqrt_information_known_) computeSqrtInformation();
  return sqrt_information_;
}

void Preintegration::computeSqrtInformation() const {
  sqrt_information_known_ = true;
  sqrt_information_.setZero();
  Matrix15d covariance = covariance_;
  covariance.diagonal() += leastDeviations().cwiseAbs2();
  // Scaled to a unit diagonal first: the units of the fifteen errors differ by orders of magnitude.
  const Vector15d scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Matrix15d> llt(scale.asDiagonal() * covariance * scale.asDiagonal());
  is_weightable_ = scale.allFinite() && llt.info() == Eigen::Success;
  if (!is_weightable_) return;
  sqrt_information_ = scale.asDiagonal();
  llt.matrixL().solveInPlace(sqrt_information_);
  is_weightable_ = sqrt_information_.allFinite();
}

Preintegration::Increments Preintegration::corrected(const Vector3d& accelerometer_bias,
                                                     const Vector3d& gyroscope_bias,
                                                     const ImuIntrinsics& intrinsics) const {
  Increments result = corrected(accelerometer_bias, gyroscope_bias);
  const ImuIntrinsics change = intrinsics - intrinsics_;
  if (change.isZero(0.0)) return result;
  const Eigen::Matrix<double, 9, 1> d = intrinsics_jacobian_ * change;
  const Vector3d turned =
      jacobian_.block<3, 3>(kRotation, kGyrBias) * (gyroscope_bias - gyroscope_bias_);
  result.alpha += d.segment<3>(kPosition);
  result.gamma = gamma_ * so3::exp(Vector3d(turned + d.segment<3>(kRotation)));
  result.beta += d.segment<3>(kVelocity);
  return result;
}

Preintegration::Increments Preintegration::corrected(const Vector3d& accelerometer_bias,
                                                     const Vector3d& gyroscope_bias) const {
  const Vector3d d_ba = accelerometer_bias - accelerometer_bias_;
  const Vector3d d_bg = gyroscope_bias - gyroscope_bias_;
  const auto J = [this](int row, int column) { return jacobian_.block<3, 3>(row, column); };
  return {alpha_ + J(kPosition, kAccBias) * d_ba + J(kPosition, kGyrBias) * d_bg,
          gamma_ * so3::exp(J(kRotation, kGyrBias) * d_bg),
          beta_ + J(kVelocity, kAccBias) * d_ba + J(kVelocity, kGyrBias) * d_bg};
}

NavState Preintegration::predict(const NavState& state, const Vector3d& g_w) const {
  const Increments d = corrected(state.accelerometer_bias, state.gyroscope_bias);
  const double t = duration_;
  NavState next = state;
  next.T_wb.position += t * state.v_w + 0.5 * t * t * g_w + state.T_wb.rotation * d.alpha;
  next.T_wb.rotation = (state.T_wb.rotation * d.gamma).normalized();
  next.v_w += t * g_w + state.T_wb.rotation * d.beta;
  return next;
}

}  // namespace vins::estimator
