#include "pose_graph/loop/pose_refinement.h"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "vins_core/so3.h"

namespace vins::pose_graph {
namespace {

using Matrix36 = Eigen::Matrix<double, 3, 6>;

constexpr int kIterations = 10;
constexpr double kConverged = 1e-8;
// Smallest over largest eigenvalue of the information matrix of a pose that is determined.
constexpr double kLeastCondition = 1e-10;

}  // namespace

Eigen::Vector3d bearingError(const SeenPoint& seen, const Pose& T_oq, Matrix36* J_error_pose) {
  const Eigen::Vector3d p = T_oq * seen.point_q;
  const double range = p.norm();
  const Eigen::Vector3d direction = p / range;
  if (J_error_pose != nullptr) {
    const Eigen::Matrix3d J_direction_p =
        (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / range;
    const Eigen::Matrix3d R_oq = T_oq.rotation.toRotationMatrix();
    J_error_pose->leftCols<3>() = J_direction_p * R_oq;
    J_error_pose->rightCols<3>() = -J_direction_p * R_oq * so3::hat(seen.point_q);
  }
  return direction - seen.bearing_o;
}

bool refinePose(const std::vector<SeenPoint>& points, double huber, Pose* T_oq) {
  Pose T = *T_oq;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    se3::Matrix6d information = se3::Matrix6d::Zero();
    se3::Vector6d gradient = se3::Vector6d::Zero();
    for (const SeenPoint& seen : points) {
      Matrix36 J;
      const Eigen::Vector3d error = bearingError(seen, T, &J);
      const double weight = huber / std::max(huber, error.norm());
      information += weight * J.transpose() * J;
      gradient += weight * J.transpose() * error;
    }
    if (!information.allFinite()) return false;
    const Eigen::SelfAdjointEigenSolver<se3::Matrix6d> eigen(information);
    const se3::Vector6d& values = eigen.eigenvalues();
    if (!(values(0) > kLeastCondition * values(5))) return false;
    const se3::Vector6d step = -(
        eigen.eigenvectors() * (eigen.eigenvectors().transpose() * gradient).cwiseQuotient(values));
    T = T * se3::exp(step);
    if (step.norm() < kConverged) break;
  }
  if (!T.position.allFinite() || !T.rotation.coeffs().allFinite()) return false;
  *T_oq = T;
  return true;
}

}  // namespace vins::pose_graph
