#include "motion_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vins_core/so3.h"
#include "vins_core/tangent_basis.h"

namespace vins::feature_tracker {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix5d = Eigen::Matrix<double, 5, 5>;
using Vector5d = Eigen::Matrix<double, 5, 1>;

constexpr double kDirectionSigma = 1.0;  // keeps the direction's equations regular [rad]
constexpr double kEpipoleRadius = 10.0;  // where the epipolar plane is not sharp any more [px]

/// Normal equations of the step (rotation, then direction).
struct NormalEquations {
  Matrix5d H = Matrix5d::Zero();
  Vector5d b = Vector5d::Zero();

  void add(const Vector5d& J, double residual) {
    H.noalias() += J * J.transpose();
    b.noalias() -= J * residual;
  }
};

void addPair(const BearingPair& pair, const RelativeMotion& motion, const Matrix3d& R_21,
             const Eigen::Matrix<double, 3, 2>& directions, const MotionFitOptions& options,
             NormalEquations* equations) {
  const Vector3d turned = R_21 * pair.first;
  const Vector3d normal = motion.t_21.cross(turned);
  const double fade = kEpipoleRadius * pair.angular_resolution;
  const double scale =
      1.0 / (pair.angular_resolution * std::sqrt(normal.squaredNorm() + fade * fade));
  const double residual = scale * pair.second.dot(normal);
  const double ratio = residual / options.scale;  // 0 where the scale is infinite
  // The root of Geman and McClure's weight.
  const double root_weight = 1.0 / ((1.0 + ratio * ratio) * options.sigma);
  Vector5d J;
  J.head<3>() = scale * turned.cross(pair.second.cross(motion.t_21));
  J.tail<2>() = scale * directions.transpose() * turned.cross(pair.second);
  equations->add(root_weight * J, root_weight * residual);
}

}  // namespace

void EpipolarTable::assign(const std::vector<BearingPair>& pairs) {
  const Eigen::Index count = static_cast<Eigen::Index>(pairs.size());
  for (std::size_t k = 0; k < 3; ++k) first_[k].resize(count), second_[k].resize(count);
  squared_resolution_.resize(count), least_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const BearingPair& pair = pairs[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) {
      first_[k][i] = static_cast<float>(pair.first[k]);
      second_[k][i] = static_cast<float>(pair.second[k]);
    }
    const double square = pair.angular_resolution * pair.angular_resolution;
    squared_resolution_[i] = static_cast<float>(square);
    least_[i] = static_cast<float>(kEpipoleRadius * kEpipoleRadius * square * square);
  }
}

void EpipolarTable::squaredDistances(const RelativeMotion& motion, std::vector<float>* squares) {
  const Eigen::Matrix3f E = (so3::hat(motion.t_21) * motion.R_21.toRotationMatrix()).cast<float>();
  squares->resize(static_cast<std::size_t>(least_.size()));
  for (int k = 0; k < 3; ++k) {
    normal_[k] = E(k, 0) * first_[0] + E(k, 1) * first_[1] + E(k, 2) * first_[2];
  }
  const auto& [x, y, z] = normal_;
  Eigen::Map<Column>(squares->data(), least_.size()) =
      (x * second_[0] + y * second_[1] + z * second_[2]).square() /
      (squared_resolution_ * (x.square() + y.square() + z.square()) + least_);
}

double epipolarDistance(const BearingPair& pair, const RelativeMotion& motion) {
  const Vector3d normal = motion.t_21.cross(motion.R_21 * pair.first);
  const double fade = kEpipoleRadius * pair.angular_resolution;
  return std::abs(pair.second.dot(normal)) /
         (pair.angular_resolution * std::sqrt(normal.squaredNorm() + fade * fade));
}

double parallax(const BearingPair& pair, const Eigen::Quaterniond& R_21) {
  return (pair.second - R_21 * pair.first).norm() / pair.angular_resolution;
}

double displacement(const BearingPair& pair, const RelativeMotion& motion) {
  const Vector3d turned = motion.R_21 * pair.first;
  const Vector3d along = motion.t_21 - motion.t_21.dot(turned) * turned;
  const double length = along.norm();
  if (length < kEpipoleRadius * pair.angular_resolution) return 0.0;
  return (pair.second - turned).dot(along) / (length * pair.angular_resolution);
}

void stepMotion(const std::vector<BearingPair>& pairs, const std::vector<std::size_t>& sample,
                const MotionFitOptions& options, RelativeMotion* motion) {
  NormalEquations equations;
  const Matrix3d R_21 = motion->R_21.toRotationMatrix();
  const Eigen::Matrix<double, 3, 2> directions = tangentBasis(motion->t_21);
  const auto add = [&](const BearingPair& pair) {
    addPair(pair, *motion, R_21, directions, options, &equations);
  };
  if (sample.empty()) {
    for (const BearingPair& pair : pairs) add(pair);
  } else {
    for (const std::size_t i : sample) add(pairs[i]);
  }
  const double information = 1.0 / (options.rotation_sigma * options.rotation_sigma);
  equations.H.diagonal().head<3>().array() += information;
  equations.b.head<3>() -= information * so3::log(motion->R_21 * options.R_prior.conjugate());
  equations.H.diagonal().tail<2>().array() += 1.0 / (kDirectionSigma * kDirectionSigma);
  const Vector5d step = equations.H.ldlt().solve(equations.b);
  if (!step.allFinite() || step.head<3>().norm() > 0.5) return;
  motion->R_21 = (so3::exp(step.head<3>()) * motion->R_21).normalized();
  motion->t_21 = (motion->t_21 + directions * step.tail<2>()).normalized();
}

Eigen::Quaterniond fitRotation(const std::vector<BearingPair>& pairs,
                               const Eigen::Quaterniond& R_21_start) {
  Eigen::Quaterniond R_21 = R_21_start;
  std::vector<double> lengths(pairs.size());
  for (int iteration = 0; iteration < 6; ++iteration) {
    for (std::size_t i = 0; i < pairs.size(); ++i) lengths[i] = parallax(pairs[i], R_21);
    std::vector<double> sorted = lengths;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    const double scale = std::max(0.5, sorted[sorted.size() / 2]);
    Matrix3d H = 1e-9 * Matrix3d::Identity();
    Vector3d b = Vector3d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Vector3d turned = R_21 * pairs[i].first;
      const double ratio = lengths[i] / scale;
      const double weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
      H += weight * (Matrix3d::Identity() - turned * turned.transpose());
      b += weight * turned.cross(pairs[i].second);
    }
    R_21 = (so3::exp(H.ldlt().solve(b)) * R_21).normalized();
  }
  return R_21;
}

void faceForward(const std::vector<BearingPair>& pairs, double threshold, RelativeMotion* motion) {
  int ahead = 0, behind = 0;
  for (const BearingPair& pair : pairs) {
    if (epipolarDistance(pair, *motion) > threshold) continue;
    const double along = displacement(pair, *motion);
    if (along > threshold) ++ahead;
    if (along < -threshold) ++behind;
  }
  if (behind > ahead) motion->t_21 = -motion->t_21;
}

}  // namespace vins::feature_tracker
