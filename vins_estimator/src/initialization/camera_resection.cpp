#include "vins_estimator/initialization/camera_resection.h"

#include <cmath>
#include <string>

#include <Eigen/Cholesky>

#include "vins_core/option_check.h"
#include "vins_core/so3.h"
#include "vins_estimator/factors/bearing_factor.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Norm of the weighted tangent-plane residual; of a point behind the camera, more than any gate.
double residualNorm(const PointSighting& sighting, const Pose& T_cs) {
  constexpr double kBehind = 1e6;
  const Vector3d unit = (T_cs * sighting.position_s).normalized();
  const double cosine = unit.dot(sighting.bearing);
  if (!(cosine > 0.0)) return kBehind;
  return sighting.inverse_sigma * unit.cross(sighting.bearing).norm();
}

double huber(double norm, double bound) {
  return norm <= bound ? norm * norm : bound * (2.0 * norm - bound);
}

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
};

/// By the position (in s) and the rotation on the right.
NormalEquations linearize(const std::vector<PointSighting>& sightings, const Pose& T_sc,
                          double robust) {
  NormalEquations equations;
  const Eigen::Matrix3d R_cs = T_sc.rotation.conjugate().toRotationMatrix();
  for (const PointSighting& sighting : sightings) {
    const Vector3d in_camera = R_cs * (sighting.position_s - T_sc.position);
    const double inverse_length = 1.0 / (in_camera.norm() + 1e-30);
    const Vector3d unit = inverse_length * in_camera;
    const Eigen::Matrix<double, 3, 2> basis = tangentBasis(sighting.bearing);
    const Eigen::Vector2d tangent = basis.transpose() * unit;
    Eigen::Matrix<double, 3, 6> J_point;
    J_point << -R_cs, so3::hat(in_camera);
    const Eigen::Matrix<double, 2, 6> J = sighting.inverse_sigma * inverse_length *
                                          (basis.transpose() - tangent * unit.transpose()) *
                                          J_point;
    const Eigen::Vector2d residual = sighting.inverse_sigma * tangent;
    const double norm = residual.norm();
    const double weight = norm <= robust ? 1.0 : robust / norm;
    equations.H += weight * J.transpose() * J;
    equations.g += weight * J.transpose() * residual;
  }
  return equations;
}

double cost(const std::vector<PointSighting>& sightings, const Pose& T_sc, double robust) {
  const Pose T_cs = T_sc.inverse();
  double sum = 0.0;
  for (const PointSighting& sighting : sightings) {
    sum += huber(residualNorm(sighting, T_cs), robust);
  }
  return sum;
}

Pose moved(const Pose& T_sc, const Vector6d& step) {
  return {(T_sc.rotation * so3::exp(step.tail<3>())).normalized(), T_sc.position + step.head<3>()};
}

/// Levenberg and Marquardt.
Pose minimize(const std::vector<PointSighting>& sightings, const Pose& start,
              const ResectionOptions& options) {
  constexpr double kConverged = 1e-5;  // relative decrease
  Pose T_sc = start;
  double present = cost(sightings, T_sc, options.robust), damping = 1e-4;
  for (int i = 0; i < options.max_iterations; ++i) {
    NormalEquations equations = linearize(sightings, T_sc, options.robust);
    equations.H.diagonal() *= 1.0 + damping;
    const Vector6d step = -equations.H.ldlt().solve(equations.g);
    if (!step.allFinite()) break;
    const Pose next = moved(T_sc, step);
    const double next_cost = cost(sightings, next, options.robust);
    if (!(next_cost < present)) {
      damping *= 10.0;
      continue;
    }
    const bool converged = present - next_cost < kConverged * present;
    T_sc = next;
    present = next_cost;
    damping *= 0.1;
    if (converged) break;
  }
  return T_sc;
}

}  // namespace

void ResectionOptions::validate() const {
  if (min_points < 4) refuseOption("resection", "min_points", min_points, "at least 4");
  if (!(min_inliers > 0.0 && min_inliers <= 1.0))
    refuseOption("resection", "min_inliers", min_inliers, "above 0 to 1");
  requirePositive("resection", "inlier_gate", inlier_gate);
  requirePositive("resection", "robust", robust);
  if (max_iterations < 1) refuseOption("resection", "max_iterations", max_iterations, "at least 1");
}

std::optional<Pose> resectCamera(const std::vector<PointSighting>& sightings, const Pose& start,
                                 const ResectionOptions& options) {
  if (static_cast<int>(sightings.size()) < options.min_points) return std::nullopt;
  const Pose T_sc = minimize(sightings, start, options);
  const Pose T_cs = T_sc.inverse();
  int inliers = 0;
  for (const PointSighting& sighting : sightings) {
    if (residualNorm(sighting, T_cs) <= options.inlier_gate) ++inliers;
  }
  const bool enough = inliers >= options.min_points &&
                      inliers >= options.min_inliers * static_cast<double>(sightings.size());
  if (!enough) return std::nullopt;
  return T_sc;
}

}  // namespace vins::estimator
