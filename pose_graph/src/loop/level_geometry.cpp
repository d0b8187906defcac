#include "pose_graph/loop/level_geometry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace vins::pose_graph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegenerate = 1e-9;
constexpr double kYawStep = 0.03;        // [rad]: the determinant has at most six roots in a turn
constexpr int kBisections = 12;          // to 1.5e-5 rad, a hundredth of a pixel
constexpr double kEpipoleRadius = 0.05;  // [rad]

Vector3d turned(const Vector3d& v, double cosine, double sine) {
  return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y(), v.z()};
}

Matrix3d planeNormals(const std::array<LevelBearings, 3>& pairs, double yaw) {
  const double cosine = std::cos(yaw), sine = std::sin(yaw);
  Matrix3d normals;
  for (int i = 0; i < 3; ++i) {
    normals.row(i) = turned(pairs[i].query, cosine, sine).cross(pairs[i].old).transpose();
  }
  return normals;
}

/// The direction that is orthogonal to all rows, which lie in a plane: their longest cross product.
Vector3d orthogonalTo(const Matrix3d& rows) {
  Vector3d best = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3d a = rows.row(i).transpose(), b = rows.row((i + 1) % 3).transpose();
    const Vector3d cross = a.cross(b);
    if (cross.squaredNorm() > best.squaredNorm()) best = cross;
  }
  const double norm = best.norm();
  return norm > 0.0 ? Vector3d(best / norm) : Vector3d::UnitX();
}

double rootBetween(const std::array<LevelBearings, 3>& pairs, double low, double high,
                   double value_low) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    const bool is_above = (planeNormals(pairs, middle).determinant() < 0.0) == (value_low < 0.0);
    (is_above ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<YawTranslation> solveTwoPoints(const LevelPoint& first, const LevelPoint& second) {
  const Vector3d difference = first.point - second.point;
  const Vector3d normal = first.direction.cross(second.direction);
  const double a = normal.x() * difference.x() + normal.y() * difference.y();
  const double b = normal.y() * difference.x() - normal.x() * difference.y();
  const double c = normal.z() * difference.z();
  const double amplitude = std::hypot(a, b);
  if (amplitude < kDegenerate || std::abs(c) > amplitude) return {};
  const double middle = std::atan2(b, a), half = std::acos(-c / amplitude);
  const double cosine = first.direction.dot(second.direction);
  const double sine_squared = normal.squaredNorm();
  std::vector<YawTranslation> solutions;
  for (const double yaw : {middle - half, middle + half}) {
    // v = depth_1 d_1 - depth_2 d_2, which holds in their plane.
    const Vector3d v = turned(difference, std::cos(yaw), std::sin(yaw));
    const double along_first = v.dot(first.direction), along_second = v.dot(second.direction);
    const double depth_first = (along_first - cosine * along_second) / sine_squared;
    const double depth_second = (cosine * along_first - along_second) / sine_squared;
    if (depth_first <= 0.0 || depth_second <= 0.0) continue;
    solutions.push_back(
        {std::remainder(yaw, 2.0 * M_PI),
         depth_first * first.direction - turned(first.point, std::cos(yaw), std::sin(yaw))});
  }
  return solutions;
}

std::vector<YawDirection> solveThreeBearings(const std::array<LevelBearings, 3>& pairs,
                                             double max_yaw) {
  const int steps = std::max(2, static_cast<int>(std::ceil(2.0 * max_yaw / kYawStep)));
  std::vector<YawDirection> solutions;
  double yaw = -max_yaw, value = planeNormals(pairs, yaw).determinant();
  for (int i = 1; i <= steps; ++i) {
    const double next = max_yaw * (2.0 * i / steps - 1.0);
    const double next_value = planeNormals(pairs, next).determinant();
    if ((value < 0.0) != (next_value < 0.0)) {
      const double root = rootBetween(pairs, yaw, next, value);
      solutions.push_back({root, orthogonalTo(planeNormals(pairs, root))});
    }
    yaw = next, value = next_value;
  }
  return solutions;
}

double epipolarError(const LevelBearings& pair, const YawDirection& motion) {
  const Vector3d query = turned(pair.query, std::cos(motion.yaw), std::sin(motion.yaw));
  const Vector3d normal = motion.direction.cross(query);
  return std::abs(normal.dot(pair.old)) / std::max(normal.norm(), kEpipoleRadius);
}

}  // namespace vins::pose_graph
