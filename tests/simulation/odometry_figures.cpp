#include "simulation/odometry_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

constexpr double kEarly = 2.0;         ///< of the early scale error [s]
constexpr double kLeastSpread = 0.05;  ///< of positions that tell a scale [m]

Vector3d meanOf(const Positions& positions) {
  const Vector3d sum = std::accumulate(positions.begin(), positions.end(), Vector3d(0, 0, 0));
  return sum / static_cast<double>(positions.size());
}

/// Sum of (truth - mean) (estimated - mean)^T.
Eigen::Matrix3d crossCovariance(const Positions& estimated, const Positions& truth) {
  const Vector3d estimated_mean = meanOf(estimated), true_mean = meanOf(truth);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += (truth[i] - true_mean) * (estimated[i] - estimated_mean).transpose();
  }
  return sum;
}

double squaredSpread(const Positions& positions) {
  const Vector3d mean = meanOf(positions);
  double sum = 0.0;
  for (const Vector3d& p : positions) sum += (p - mean).squaredNorm();
  return sum;
}

/// The turn about z that makes trace(R_z^T M) greatest.
Eigen::Quaterniond yawOf(const Eigen::Matrix3d& M) {
  const double angle = std::atan2(M(1, 0) - M(0, 1), M(0, 0) + M(1, 1));
  return so3::exp(angle * Vector3d::UnitZ());
}

Positions estimatedPositions(const OdometryRun& run, Stamp last) {
  Positions positions;
  for (const OdometrySample& sample : run.samples) {
    if (sample.estimate.stamp <= last) positions.push_back(sample.estimate.state.T_wb.position);
  }
  return positions;
}

Positions truePositions(const OdometryRun& run, Stamp last) {
  Positions positions;
  for (const OdometrySample& sample : run.samples) {
    if (sample.estimate.stamp <= last) positions.push_back(sample.truth.T_wb.position);
  }
  return positions;
}

double lengthOf(const Positions& positions) {
  double sum = 0.0;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    sum += (positions[i] - positions[i - 1]).norm();
  }
  return sum;
}

/// The true state as the estimate's world has it.
estimator::NavState movedBy(const Pose& T, const estimator::NavState& state) {
  estimator::NavState moved = state;
  moved.T_wb = T * state.T_wb;
  moved.v_w = T.rotation * state.v_w;
  return moved;
}

/// NEES per degree of freedom of `size` error states from `begin` on; not finite where the
/// covariance is not positive definite.
double nees(const estimator::Vector15d& error, const estimator::Matrix15d& covariance, int begin,
            int size) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance.block(begin, begin, size, size));
  if (cholesky.info() != Eigen::Success) return std::nan("");
  const Eigen::VectorXd e = error.segment(begin, size);
  return e.dot(cholesky.solve(e)) / size;
}

void add(const estimator::Vector15d& error, const estimator::Matrix15d& covariance,
         Consistency* sum) {
  sum->position += nees(error, covariance, estimator::kPosition, 3);
  sum->rotation += nees(error, covariance, estimator::kRotation, 3);
  sum->pose += nees(error, covariance, estimator::kPosition, 6);
  sum->velocity += nees(error, covariance, estimator::kVelocity, 3);
  sum->accelerometer_bias += nees(error, covariance, estimator::kAccBias, 3);
  sum->gyroscope_bias += nees(error, covariance, estimator::kGyrBias, 3);
}

bool isFinite(const Consistency& c) {
  return std::isfinite(c.position + c.rotation + c.pose + c.velocity + c.accelerometer_bias +
                       c.gyroscope_bias);
}

void scale(double factor, Consistency* c) {
  for (double* value : {&c->position, &c->rotation, &c->pose, &c->velocity, &c->accelerometer_bias,
                        &c->gyroscope_bias}) {
    *value *= factor;
  }
}

void addTo(Consistency* sum, const Consistency& c) {
  sum->position += c.position;
  sum->rotation += c.rotation;
  sum->pose += c.pose;
  sum->velocity += c.velocity;
  sum->accelerometer_bias += c.accelerometer_bias;
  sum->gyroscope_bias += c.gyroscope_bias;
}

/// NEES and drift, from the gauge pose on.
void judgeByGauge(const OdometryRun& run, OdometryFigures* figures) {
  Pose T_estimate_truth;
  int covered = 0;
  for (const OdometrySample& sample : run.samples) {
    if (sample.gauge) {
      T_estimate_truth = alignPositionAndYaw(sample.gauge->truth, sample.gauge->estimate);
    }
    const estimator::NavState truth = movedBy(T_estimate_truth, sample.truth);
    const estimator::Vector15d error = minus(truth, sample.estimate.state);
    figures->drift = error.segment<3>(estimator::kPosition).norm();
    Consistency now;
    add(error, sample.estimate.covariance, &now);
    if (!isFinite(now)) continue;
    ++covered;
    addTo(&figures->nees, now);
  }
  if (covered > 0) scale(1.0 / covered, &figures->nees);
  figures->uncovered = 1.0 - covered / static_cast<double>(run.samples.size());
}

void judgeByAlignment(const OdometryRun& run, OdometryFigures* figures) {
  const Stamp last = run.samples.back().estimate.stamp;
  const Positions estimated = estimatedPositions(run, last), truth = truePositions(run, last);
  // Positions that hardly move tell no yaw; the first pose does.
  const OdometrySample& first = run.samples.front();
  const Pose T = scaleError(estimated, truth)
                     ? alignPositionAndYaw(estimated, truth)
                     : alignPositionAndYaw(first.estimate.state.T_wb, first.truth.T_wb);
  double position = 0.0, rotation = 0.0;
  for (const OdometrySample& sample : run.samples) {
    const Pose aligned = T * sample.estimate.state.T_wb;
    position += (aligned.position - sample.truth.T_wb.position).squaredNorm();
    rotation += so3::log(sample.truth.T_wb.rotation.conjugate() * aligned.rotation).squaredNorm();
  }
  const auto count = static_cast<double>(run.samples.size());
  figures->ate = std::sqrt(position / count);
  figures->rotation_error = std::sqrt(rotation / count);
  figures->distance = lengthOf(truth);
  figures->scale_error = scaleError(estimated, truth).value_or(0.0);
  const Stamp early = run.samples.front().estimate.stamp + toNanoseconds(kEarly);
  figures->early_scale_error =
      scaleError(estimatedPositions(run, early), truePositions(run, early));
}

void judgeTimes(const OdometryRun& run, OdometryFigures* figures) {
  std::vector<double> seconds = run.frame_seconds;
  if (seconds.empty()) return;
  const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  figures->mean_ms = 1e3 * sum / static_cast<double>(seconds.size());
  const auto nth = seconds.begin() + static_cast<std::ptrdiff_t>(0.95 * (seconds.size() - 1.0));
  std::nth_element(seconds.begin(), nth, seconds.end());
  figures->p95_ms = 1e3 * *nth;
}

}  // namespace

Pose alignPositionAndYaw(const Positions& estimated, const Positions& truth) {
  if (estimated.empty()) return {};
  const Eigen::Quaterniond R = yawOf(crossCovariance(estimated, truth));
  return {R, meanOf(truth) - R * meanOf(estimated)};
}

Pose alignPositionAndYaw(const Pose& estimated, const Pose& truth) {
  const Eigen::Quaterniond difference = truth.rotation * estimated.rotation.conjugate();
  const Eigen::Quaterniond R = yawOf(difference.toRotationMatrix());
  return {R, truth.position - R * estimated.position};
}

std::optional<double> scaleError(const Positions& estimated, const Positions& truth) {
  if (truth.size() < 2) return std::nullopt;
  const double spread = std::sqrt(squaredSpread(truth) / static_cast<double>(truth.size()));
  if (spread < kLeastSpread) return std::nullopt;
  const Eigen::MatrixXd cross = crossCovariance(estimated, truth);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d values = svd.singularValues();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) values.z() *= -1.0;
  return squaredSpread(estimated) / values.sum() - 1.0;
}

namespace {

void judgeRig(const OdometryRun& run, OdometryFigures* figures) {
  const estimator::RigVector error = minus(run.true_rig, run.rig);
  figures->extrinsic_translation_error = error.head<3>().norm();
  figures->extrinsic_rotation_error = error.segment<3>(3).norm();
  figures->td_error = std::abs(error(6));
  // What was taken as exact has next to no variance.
  std::vector<Eigen::Index> estimated;
  for (Eigen::Index i = 0; i < 7; ++i) {
    if (run.rig_covariance(i, i) > 1e-16) estimated.push_back(i);
  }
  if (estimated.empty()) return;
  const Eigen::VectorXd part = error(estimated);
  const Eigen::MatrixXd covariance = run.rig_covariance(estimated, estimated);
  figures->nees_rig =
      part.dot(covariance.llt().solve(part)) / static_cast<double>(estimated.size());
}

}  // namespace

OdometryFigures evaluate(const OdometryRun& run) {
  OdometryFigures figures;
  figures.seed = run.seed;
  judgeTimes(run, &figures);
  if (run.samples.empty()) return figures;
  figures.initialised = true;
  figures.completeness = run.samples.size() / static_cast<double>(run.frames);
  figures.time_to_initialise = toSeconds(run.samples.front().estimate.stamp - run.begin);
  const auto sequences =
      run.samples.back().estimate.sequence - run.samples.front().estimate.sequence;
  figures.resets = sequences;
  judgeRig(run, &figures);
  judgeByAlignment(run, &figures);
  judgeByGauge(run, &figures);
  return figures;
}

}  // namespace vins::simulation
