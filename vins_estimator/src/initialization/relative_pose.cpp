#include "vins_estimator/initialization/relative_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <unordered_map>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include "vins_core/option_check.h"
#include "vins_core/so3.h"
#include "vins_estimator/factors/bearing_factor.h"
#include "vins_estimator/initialization/five_point.h"

namespace vins::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNearlyAsGood = 2.0;      ///< cost of a second solution over that of the best
constexpr double kApart = 0.02;            ///< rotation between the two [rad]
constexpr double kLeastIterations = 10.0;  ///< that a second solution may be found

/// Different whole numbers below `size`. The standard leaves its distributions to the library; this
/// is the same everywhere.
std::array<std::size_t, 5> drawFive(std::size_t size, std::mt19937_64* engine) {
  std::array<std::size_t, 5> indices{};
  for (std::size_t i = 0; i < indices.size();) {
    indices[i] = static_cast<std::size_t>((*engine)() % size);
    if (std::find(indices.begin(), indices.begin() + i, indices[i]) == indices.begin() + i) ++i;
  }
  return indices;
}

Matrix3d essential(const Pose& T_12) {
  // b1^T [t] R b2 = 0 in the first camera's frame, transposed.
  return (so3::hat(T_12.position) * T_12.rotation.toRotationMatrix()).transpose();
}

/// In front of both cameras at the distances where the rays come closest.
bool isBeforeBoth(const Pose& T_12, const BearingPair& pair) {
  const Vector3d second = T_12.rotation * pair.second;
  const double cosine = pair.first.dot(second);
  const double along_first = pair.first.dot(T_12.position);
  const double along_second = second.dot(T_12.position);
  // Distances times 1 - cosine^2, which is positive.
  return along_first - cosine * along_second > 0.0 && cosine * along_first - along_second > 0.0;
}

class Ransac {
 public:
  Ransac(const std::vector<BearingPair>& pairs, const Eigen::Quaterniond& R_12_gyro,
         double max_angle, const RelativePoseOptions& options, std::uint64_t seed)
      : pairs_(pairs),
        R_12_gyro_(R_12_gyro),
        max_angle_(max_angle),
        options_(options),
        engine_(seed) {}

  std::vector<RelativePose> run();

 private:
  double cost(const Matrix3d& E) const;
  void trySample();
  std::optional<Pose> bestDecomposition(const Matrix3d& E) const;
  int countBeforeBoth(const Pose& T_12, const Matrix3d& E) const;
  double iterationsNeeded() const;
  void keep(const Pose& T_12, double T_cost);
  RelativePose withInliers(const Pose& T_12) const;
  Pose refined(const RelativePose& start) const;
  std::optional<RelativePose> finished(const RelativePose& start) const;

  const std::vector<BearingPair>& pairs_;
  const Eigen::Quaterniond R_12_gyro_;
  const double max_angle_;
  const RelativePoseOptions& options_;
  std::mt19937_64 engine_;
  std::optional<double> best_cost_;
  RelativePose best_;
  std::optional<double> second_cost_;
  Pose second_;
};

/// Truncated squares (MSAC): P. Torr, A. Zisserman, "MLESAC", CVIU 2000.
double Ransac::cost(const Matrix3d& E) const {
  const double gate = options_.inlier_gate * options_.inlier_gate;
  double sum = 0.0;
  for (const BearingPair& pair : pairs_) {
    const double residual = epipolarResidual(E, pair);
    sum += std::min(gate, residual * residual);
  }
  return sum;
}

int Ransac::countBeforeBoth(const Pose& T_12, const Matrix3d& E) const {
  int count = 0;
  for (const BearingPair& pair : pairs_) {
    if (std::abs(epipolarResidual(E, pair)) > options_.inlier_gate) continue;
    count += isBeforeBoth(T_12, pair) ? 1 : -1;
  }
  return count;
}

std::optional<Pose> Ransac::bestDecomposition(const Matrix3d& E) const {
  const Eigen::JacobiSVD<Matrix3d> svd(E.transpose(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d W;
  W << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Vector3d t = svd.matrixU().col(2);
  std::optional<Pose> best;
  int best_count = 0;
  for (const Matrix3d& turn : {W, Matrix3d(W.transpose())}) {
    Matrix3d R = svd.matrixU() * turn * svd.matrixV().transpose();
    if (R.determinant() < 0.0) R = -R;
    const Eigen::Quaterniond R_12(R);
    if (R_12.angularDistance(R_12_gyro_) > max_angle_) continue;
    for (const double sign : {1.0, -1.0}) {
      const Pose T_12(R_12, sign * t);
      const int count = countBeforeBoth(T_12, E);
      if (count <= best_count) continue;
      best_count = count;
      best = T_12;
    }
  }
  return best;
}

void Ransac::trySample() {
  const auto indices = drawFive(pairs_.size(), &engine_);
  Eigen::Matrix<double, 3, 5> first, second;
  for (int i = 0; i < 5; ++i) {
    first.col(i) = pairs_[indices[i]].first;
    second.col(i) = pairs_[indices[i]].second;
  }
  for (const Matrix3d& E : essentialMatrices(first, second)) {
    const double E_cost = cost(E);
    if (best_cost_ && E_cost >= kNearlyAsGood * *best_cost_) continue;
    if (const auto T_12 = bestDecomposition(E)) keep(*T_12, E_cost);
  }
}

/// As the best or as the second, a rotation apart from it.
void Ransac::keep(const Pose& T_12, double T_cost) {
  const bool differs = best_cost_ && T_12.rotation.angularDistance(best_.T_12.rotation) > kApart;
  if (!best_cost_ || T_cost < *best_cost_) {
    if (differs) {
      second_ = best_.T_12;
      second_cost_ = best_cost_;
    }
    best_cost_ = T_cost;
    best_ = withInliers(T_12);
  } else if (differs && (!second_cost_ || T_cost < *second_cost_)) {
    second_ = T_12;
    second_cost_ = T_cost;
  }
}

RelativePose Ransac::withInliers(const Pose& T_12) const {
  const Matrix3d E = essential(T_12);
  RelativePose result;
  result.T_12 = T_12;
  result.inliers.assign(pairs_.size(), false);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (std::abs(epipolarResidual(E, pairs_[i])) > options_.inlier_gate) continue;
    result.inliers[i] = true;
    ++result.inlier_count;
  }
  return result;
}

double Ransac::iterationsNeeded() const {
  const double share = static_cast<double>(best_.inlier_count) / pairs_.size();
  const double good = std::pow(share, 5);
  if (good >= 1.0) return 1.0;
  return std::log(1.0 - options_.confidence) / std::log(std::max(1e-12, 1.0 - good));
}

/// Gauss-Newton in the rotation (on the right) and the direction of the translation; the residuals'
/// denominators are held in each step.
Pose Ransac::refined(const RelativePose& start) const {
  Pose T_12 = start.T_12;
  for (int i = 0; i < options_.refinements; ++i) {
    const Matrix3d E = essential(T_12);
    const Matrix3d R = T_12.rotation.toRotationMatrix();
    const Eigen::Matrix<double, 3, 2> sideways = tangentBasis(T_12.position);
    Eigen::Matrix<double, 5, 5> H = 1e-9 * Eigen::Matrix<double, 5, 5>::Identity();
    Eigen::Matrix<double, 5, 1> g = Eigen::Matrix<double, 5, 1>::Zero();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (!start.inliers[k]) continue;
      const BearingPair& pair = pairs_[k];
      const double weight = 1.0 / (pair.sigma * std::hypot((E * pair.first).norm(),
                                                           (E.transpose() * pair.second).norm()));
      // b1 . (t x R b2)
      const Vector3d turned = R * pair.second;
      const Vector3d J_rotation =
          -(pair.first.cross(T_12.position).transpose() * R * so3::hat(pair.second)).transpose();
      Eigen::Matrix<double, 5, 1> J;
      J << J_rotation, sideways.transpose() * turned.cross(pair.first);
      J *= weight;
      H += J * J.transpose();
      g += J * (weight * pair.first.dot(T_12.position.cross(turned)));
    }
    const Eigen::Matrix<double, 5, 1> step = -H.ldlt().solve(g);
    if (!step.allFinite()) return start.T_12;
    T_12.rotation = (T_12.rotation * so3::exp(step.head<3>())).normalized();
    T_12.position = (T_12.position + sideways * step.tail<2>()).normalized();
  }
  return T_12;
}

/// Refined on its inliers where that is better; nothing where too few agree.
std::optional<RelativePose> Ransac::finished(const RelativePose& start) const {
  RelativePose result = withInliers(refined(start));
  if (cost(essential(result.T_12)) > cost(essential(start.T_12))) result = start;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (!result.inliers[i] || isBeforeBoth(result.T_12, pairs_[i])) continue;
    result.inliers[i] = false;
    --result.inlier_count;
  }
  if (result.inlier_count < options_.min_inliers * pairs_.size()) return std::nullopt;
  return result;
}

std::vector<RelativePose> Ransac::run() {
  for (int i = 0; i < options_.max_iterations; ++i) {
    trySample();
    if (best_cost_ && i + 1 >= std::max(kLeastIterations, iterationsNeeded())) break;
  }
  std::vector<RelativePose> found;
  if (!best_cost_) return found;
  if (const auto best = finished(best_)) found.push_back(*best);
  if (!second_cost_ || *second_cost_ > kNearlyAsGood * *best_cost_) return found;
  const auto second = finished(withInliers(second_));
  const bool differs = second && (found.empty() || second->T_12.rotation.angularDistance(
                                                       found.front().T_12.rotation) > 0.5 * kApart);
  if (differs) found.push_back(*second);
  return found;
}

}  // namespace

std::vector<BearingPair> sharedBearings(const FeatureFrame& first, const FeatureFrame& second,
                                        double pixel_noise) {
  std::unordered_map<std::int64_t, const FeatureObservation*> by_id;
  for (const FeatureObservation& o : first.observations) {
    if (o.camera == 0) by_id.emplace(o.id, &o);
  }
  std::vector<BearingPair> pairs;
  for (const FeatureObservation& o : second.observations) {
    const auto it = by_id.find(o.id);
    if (o.camera != 0 || it == by_id.end()) continue;
    pairs.push_back({it->second->bearing, o.bearing, pixel_noise * o.angular_resolution});
  }
  return pairs;
}

void RelativePoseOptions::validate() const {
  requirePositive("relative pose", "inlier_gate", inlier_gate);
  if (!(min_inliers > 0.0 && min_inliers <= 1.0))
    refuseOption("relative pose", "min_inliers", min_inliers, "above 0 to 1");
  if (max_iterations < 1)
    refuseOption("relative pose", "max_iterations", max_iterations, "at least 1");
  if (!(confidence > 0.0 && confidence < 1.0))
    refuseOption("relative pose", "confidence", confidence, "between 0 and 1");
  if (refinements < 0) refuseOption("relative pose", "refinements", refinements, "at least 0");
}

double epipolarResidual(const Matrix3d& E, const BearingPair& pair) {
  const Vector3d normal_2 = E * pair.first;
  const Vector3d normal_1 = E.transpose() * pair.second;
  const double length = std::sqrt(normal_1.squaredNorm() + normal_2.squaredNorm() + 1e-30);
  return pair.second.dot(normal_2) / (pair.sigma * length);
}

std::vector<RelativePose> findRelativePoses(const std::vector<BearingPair>& pairs,
                                            const Eigen::Quaterniond& R_12_gyro, double max_angle,
                                            const RelativePoseOptions& options,
                                            std::uint64_t seed) {
  if (pairs.size() < 8) return {};
  return Ransac(pairs, R_12_gyro, max_angle, options, seed).run();
}

Eigen::Quaterniond fitRotation(const std::vector<BearingPair>& pairs,
                               const Eigen::Quaterniond& start) {
  constexpr int kIterations = 10;
  constexpr double kRobust = 3.0;  // deviations beyond which a pair pulls with constant force
  Eigen::Quaterniond R_12 = start;
  for (int i = 0; i < kIterations; ++i) {
    Matrix3d H = 1e-9 * Matrix3d::Identity();
    Vector3d g = Vector3d::Zero();
    for (const BearingPair& pair : pairs) {
      // In the second camera: exp(d) b2 is to meet R^T b1; b2 x (R^T b1) is the rotation across b2.
      const Vector3d target = R_12.conjugate() * pair.first;
      const Vector3d turn = pair.second.cross(target);
      const double distance = turn.norm() / pair.sigma;
      const double weight = distance > kRobust ? kRobust / distance : 1.0;
      H += weight * (Matrix3d::Identity() - pair.second * pair.second.transpose());
      g += weight * turn;
    }
    const Vector3d step = H.ldlt().solve(g);
    if (!step.allFinite()) return start;
    R_12 = (R_12 * so3::exp(step)).normalized();
    if (step.norm() < 1e-7) break;
  }
  return R_12;
}

double medianParallax(const std::vector<BearingPair>& pairs, const Eigen::Quaterniond& R_12) {
  if (pairs.empty()) return 0.0;
  std::vector<double> angles;
  for (const BearingPair& pair : pairs) {
    const Vector3d turned = R_12 * pair.second;
    angles.push_back(std::atan2(pair.first.cross(turned).norm(), pair.first.dot(turned)) /
                     pair.sigma);
  }
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::nth_element(angles.begin(), middle, angles.end());
  return *middle;
}

}  // namespace vins::estimator
