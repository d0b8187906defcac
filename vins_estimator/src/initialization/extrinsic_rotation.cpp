#include "vins_estimator/initialization/extrinsic_rotation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Matrix37d = Eigen::Matrix<double, 3, 7>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// Unknowns: errors of R_bc (right), td, bias.
constexpr int kTd = 3;
constexpr int kBias = 4;

/// Disagreement of a turn and its derivative by the unknowns.
Vector3d disagreement(const TurnPair& pair, const TurnCalibration& at, Matrix37d* J) {
  const Matrix3d R = at.R_bc.toRotationMatrix();
  J->leftCols<3>() = R * so3::hat(pair.camera);
  J->col(kTd) = pair.rate_change;
  J->rightCols<3>() = -pair.duration * Matrix3d::Identity();
  return pair.body + (at.td - pair.td_used) * pair.rate_change - pair.duration * at.gyroscope_bias -
         R * pair.camera;
}

/// Normal equations of all turns and of what was known before.
struct TurnSystem {
  Matrix7d H = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
  double squares = 0.0;  ///< weighted, of the turns [deviations^2]
  double weights = 0.0;
  int agreeing = 0;

  void addPrior(const TurnCalibration& at, const TurnCalibration& guess, const TurnPrior& prior) {
    Vector7d error = Vector7d::Zero();
    Vector7d inverse_sigma = Vector7d::Zero();
    if (prior.rotation_sigma > 0.0) {
      error.head<3>() = so3::log(guess.R_bc.conjugate() * at.R_bc);
      inverse_sigma.head<3>().setConstant(1.0 / prior.rotation_sigma);
    }
    error(kTd) = at.td - guess.td;
    inverse_sigma(kTd) = 1.0 / prior.td_sigma;
    error.tail<3>() = at.gyroscope_bias;
    inverse_sigma.tail<3>().setConstant(1.0 / prior.bias_sigma);
    H.diagonal() += inverse_sigma.cwiseAbs2();
    g += inverse_sigma.cwiseAbs2().cwiseProduct(error);
  }

  void addTurn(const TurnPair& pair, const TurnCalibration& at, double sigma) {
    Matrix37d J;
    const Vector3d e = disagreement(pair, at, &J) / sigma;
    J /= sigma;
    // Cauchy's weight: five-point geometry is wrong now and then.
    constexpr double kScale = 3.0;  // [deviations]
    const double weight = 1.0 / (1.0 + e.squaredNorm() / (kScale * kScale));
    H += weight * J.transpose() * J;
    g += weight * J.transpose() * e;
    squares += weight * e.squaredNorm();
    weights += weight;
    agreeing += weight > 0.5;
  }
};

void move(const Vector7d& step, TurnCalibration* at) {
  at->R_bc = (at->R_bc * so3::exp(Vector3d(step.head<3>()))).normalized();
  at->td += step(kTd);
  at->gyroscope_bias += step.tail<3>();
}

}  // namespace

std::optional<Quaterniond> fitHandEyeRotation(const std::vector<TurnPair>& pairs) {
  if (pairs.size() < 2) return std::nullopt;
  Matrix3d correlation = Matrix3d::Zero();
  for (const TurnPair& pair : pairs) correlation += pair.body * pair.camera.transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs = Vector3d::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return Quaterniond(Matrix3d(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose()));
}

std::optional<TurnCalibration> calibrateByTurns(const std::vector<TurnPair>& pairs,
                                                const TurnCalibration& guess,
                                                const TurnPrior& prior, double sigma) {
  constexpr int kIterations = 12;
  if (pairs.size() < 2) return std::nullopt;
  TurnCalibration at = guess;
  TurnSystem system;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    system = TurnSystem();
    system.addPrior(at, guess, prior);
    for (const TurnPair& pair : pairs) system.addTurn(pair, at, sigma);
    const Eigen::LDLT<Matrix7d> ldlt(system.H);
    if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return std::nullopt;
    const Vector7d step = -ldlt.solve(system.g);
    if (!step.allFinite()) return std::nullopt;
    move(step, &at);
  }
  // Turns that disagree more than they should tell less than they promise.
  const double excess = std::max(1.0, system.squares / (3.0 * system.weights));
  const Matrix7d covariance = excess * system.H.inverse();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> rotation(
      Matrix3d(covariance.topLeftCorner<3, 3>()));
  at.rotation_sigma = std::sqrt(rotation.eigenvalues()(2));
  at.td_sigma = std::sqrt(covariance(kTd, kTd));
  at.pairs = system.agreeing;
  return at;
}

void TurnCalibrator::clear() {
  reference_.reset();
  pairs_.clear();
  last_report_.reset();
}

std::vector<Event> TurnCalibrator::takeEvents() { return std::exchange(events_, {}); }

void TurnCalibrator::restartAt(const FrameMeasurements& measurements) {
  reference_ = measurements.frame;
  reference_rate_ = measurements.imu.back().angular_velocity;
  turn_b_.setIdentity();
  duration_ = 0.0;
}

void TurnCalibrator::integrate(const std::vector<ImuSample>& samples) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = toSeconds(samples[i].stamp - samples[i - 1].stamp);
    turn_b_ = turn_b_ *
              so3::exp(0.5 * dt * (samples[i - 1].angular_velocity + samples[i].angular_velocity));
    duration_ += dt;
  }
}

void TurnCalibrator::compare(const FrameMeasurements& measurements,
                             const std::vector<BearingPair>& shared, double td) {
  // Without parallax a rotation alone explains the images, and better than an essential matrix.
  constexpr double kNoParallax = 3.0;  // [deviations]
  constexpr double kAnyAngle = 3.2;    // [rad]
  Quaterniond R_12 = fitRotation(shared, Quaterniond::Identity());
  if (medianParallax(shared, R_12) > kNoParallax) {
    const auto seed = static_cast<std::uint64_t>(measurements.frame.stamp);
    const std::vector<RelativePose> poses = findRelativePoses(shared, R_12, kAnyAngle, {}, seed);
    if (poses.size() != 1) return;
    R_12 = poses.front().T_12.rotation;
  }
  const Vector3d rate_change = measurements.imu.back().angular_velocity - reference_rate_;
  pairs_.push_back({so3::log(turn_b_), so3::log(R_12), rate_change, duration_, td});
  if (pairs_.size() > static_cast<std::size_t>(options_.max_pairs)) pairs_.pop_front();
}

std::optional<TurnCalibration> TurnCalibrator::addFrame(const FrameMeasurements& measurements,
                                                        double td) {
  if (measurements.imu.empty()) return std::nullopt;
  if (!reference_ || measurements.is_first || measurements.has_gap) {
    restartAt(measurements);
    return std::nullopt;
  }
  integrate(measurements.imu);
  const std::vector<BearingPair> shared =
      sharedBearings(*reference_, measurements.frame, options_.pixel_noise);
  const bool is_connected = static_cast<int>(shared.size()) >= options_.min_shared;
  const bool has_turned = so3::log(turn_b_).norm() >= options_.min_turn;
  if (is_connected && has_turned) compare(measurements, shared, td);
  if (!is_connected || has_turned) restartAt(measurements);
  const std::optional<TurnCalibration> found = fit();
  const bool enough = found && found->pairs >= options_.min_pairs;
  const bool unknown = options_.prior.rotation_sigma <= 0.0;
  if (enough && (!unknown || found->rotation_sigma <= options_.max_sigma)) return found;
  if (unknown) report(measurements.frame.stamp, found);
  return std::nullopt;
}

std::optional<TurnCalibration> TurnCalibrator::fit() const {
  const std::vector<TurnPair> pairs(pairs_.begin(), pairs_.end());
  TurnCalibration guess = guess_;
  if (options_.prior.rotation_sigma <= 0.0) {
    const std::optional<Quaterniond> R_bc = fitHandEyeRotation(pairs);
    if (!R_bc) return std::nullopt;
    guess.R_bc = *R_bc;
  }
  return calibrateByTurns(pairs, guess, options_.prior, options_.turn_sigma);
}

void TurnCalibrator::report(Stamp stamp, const std::optional<TurnCalibration>& found) {
  if (!last_report_) last_report_ = stamp;
  if (toSeconds(stamp - *last_report_) < options_.report_interval) return;
  last_report_ = stamp;
  constexpr double kNothingKnown = M_PI;  // [rad]
  events_.push_back({stamp,
                     Severity::kInfo,
                     "extrinsic_waiting",
                     "finding how the camera is mounted: turn it about two axes, texture in view",
                     {{"turns", static_cast<double>(found ? found->pairs : 0)},
                      {"turns_needed", static_cast<double>(options_.min_pairs)},
                      {"sigma_rad", found ? found->rotation_sigma : kNothingKnown},
                      {"sigma_needed_rad", options_.max_sigma}}});
}

}  // namespace vins::estimator
