#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vins_estimator/initialization/visual_inertial_alignment.h"

namespace vins::estimator {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Gravity as it is sought: g = fixed + span w.
struct GravityForm {
  Vector3d fixed = Vector3d::Zero();
  MatrixXd span = Matrix3d::Identity();
};

/// What the IMU says of the path up to a frame, in the structure's frame and in metres, without
/// the first position and velocity, and gravity.
struct PathPoint {
  double t = 0.0;                            ///< since the first frame [s]
  Vector3d displacement = Vector3d::Zero();  ///< with the camera's lever arm
  Matrix3d J_bias = Matrix3d::Zero();        ///< by the accelerometer's bias
};

std::vector<PathPoint> integratePath(const std::vector<Pose>& T_sc, const Pose& T_bc,
                                     const std::vector<Preintegration>& imu) {
  std::vector<PathPoint> path;
  double t = 0.0;
  Vector3d p = Vector3d::Zero(), v = Vector3d::Zero();
  Matrix3d J_p = Matrix3d::Zero(), J_v = Matrix3d::Zero();
  for (std::size_t i = 0; i < T_sc.size(); ++i) {
    const Matrix3d R_cb = T_bc.rotation.conjugate().toRotationMatrix();
    if (i > 0) {
      const Matrix3d R_sb = T_sc[i - 1].rotation * R_cb;
      const double dt = imu[i].duration();
      const Matrix15d& J = imu[i].jacobian();
      p += dt * v + R_sb * imu[i].alpha();
      v += R_sb * imu[i].beta();
      J_p += dt * J_v + R_sb * J.block<3, 3>(kPosition, kAccBias);
      J_v += R_sb * J.block<3, 3>(kVelocity, kAccBias);
      t += dt;
    }
    path.push_back({t, p + T_sc[i].rotation * (R_cb * T_bc.position), J_p});
  }
  return path;
}

/// Camera positions c_k = q x_k + a + b t_k + t_k^2 / 2 span w' + J_k d, with q = 1 / scale, x_k
/// the displacement with fixed gravity, and a, b, w', d first position, first velocity, w and bias,
/// all times q.
class LinearSystem {
 public:
  LinearSystem(const std::vector<Pose>& T_sc, const std::vector<PathPoint>& path)
      : T_sc_(T_sc), path_(path) {}

  /// `bias_weight`: of the bias (times q) about zero; without bias where it is infinite. False
  /// where singular.
  bool solve(const GravityForm& form, double bias_weight, LinearAlignment* result) const;

 private:
  MatrixXd coefficients(const GravityForm& form) const;

  const std::vector<Pose>& T_sc_;
  const std::vector<PathPoint>& path_;
};

MatrixXd LinearSystem::coefficients(const GravityForm& form) const {
  const Index spans = form.span.cols();
  MatrixXd A = MatrixXd::Zero(static_cast<Index>(3 * path_.size()), 10 + spans);
  for (std::size_t k = 0; k < path_.size(); ++k) {
    const PathPoint& point = path_[k];
    auto rows = A.middleRows<3>(static_cast<Index>(3 * k));
    rows.col(0) = point.displacement + 0.5 * point.t * point.t * form.fixed;
    rows.middleCols<3>(1).setIdentity();
    rows.middleCols<3>(4) = point.t * Matrix3d::Identity();
    rows.middleCols(7, spans) = 0.5 * point.t * point.t * form.span;
    rows.rightCols<3>() = point.J_bias;
  }
  return A;
}

bool LinearSystem::solve(const GravityForm& form, double bias_weight,
                         LinearAlignment* result) const {
  MatrixXd A = coefficients(form);
  VectorXd positions(A.rows());
  for (std::size_t k = 0; k < T_sc_.size(); ++k) {
    positions.segment<3>(static_cast<Index>(3 * k)) = T_sc_[k].position;
  }
  const bool has_bias = std::isfinite(bias_weight);
  if (!has_bias) A.rightCols<3>().setZero();
  MatrixXd H = A.transpose() * A;
  H.diagonal().tail<3>().array() += has_bias ? bias_weight * bias_weight : 1.0;
  const Eigen::LDLT<MatrixXd> factor(H);
  const VectorXd x = factor.solve(A.transpose() * positions);
  if (factor.info() != Eigen::Success || !x.allFinite() || x(0) == 0.0) return false;

  const double q = x(0);
  const auto degrees = static_cast<double>(std::max<Index>(A.rows() - A.cols(), 1));
  result->position_sigma = std::sqrt((A * x - positions).squaredNorm() / degrees);
  result->scale = 1.0 / q;
  result->scale_sigma = result->position_sigma / std::abs(q) *
                        std::sqrt(std::max(0.0, factor.solve(VectorXd::Unit(x.size(), 0))(0)));
  result->v_s = x.segment<3>(4) / q;
  result->g_s = form.fixed + form.span * x.segment(7, form.span.cols()) / q;
  result->accelerometer_bias = x.tail<3>() / q;
  return true;
}

}  // namespace

std::optional<LinearAlignment> alignLinearly(const std::vector<Pose>& T_sc, const Pose& T_bc,
                                             const std::vector<Preintegration>& imu, double gravity,
                                             double bias_sigma) {
  constexpr int kIterations = 10;
  constexpr double kDirectionStands = 1e-6;  // [rad]
  constexpr double kLeastScatter = 1e-6;  // of the positions, lest the bias be left without prior
  const std::vector<PathPoint> path = integratePath(T_sc, T_bc, imu);
  const LinearSystem system(T_sc, path);
  LinearAlignment result;
  if (!system.solve(GravityForm(), INFINITY, &result)) return std::nullopt;
  result.free_gravity = result.g_s.norm();
  for (int i = 0; i < kIterations; ++i) {
    // Deviations of the positions over those of the bias times q.
    const double weight =
        std::max(result.position_sigma, kLeastScatter) * std::abs(result.scale) / bias_sigma;
    const Vector3d direction = result.g_s.normalized();
    const GravityForm form{gravity * direction, gravity * tangentBasis(direction)};
    if (!system.solve(form, weight, &result)) return std::nullopt;
    if (result.g_s.normalized().cross(direction).norm() < kDirectionStands) break;
  }
  return result;
}

}  // namespace vins::estimator
