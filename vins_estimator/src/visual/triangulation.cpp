#include "vins_estimator/visual/triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Cholesky>

#include "vins_core/option_check.h"

namespace vins::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Cosine of the largest angle between two of the unit rays.
double smallestCosine(const std::vector<TriangulationView>& views) {
  double smallest = 1.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Vector3d ray_i = views[i].T_wc.rotation * views[i].bearing;
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const Vector3d ray_j = views[j].T_wc.rotation * views[j].bearing;
      smallest = std::min(smallest, ray_i.dot(ray_j));
    }
  }
  return smallest;
}

/// The point with the least sum of squared distances from the rays.
Vector3d nearestPoint(const std::vector<TriangulationView>& views) {
  // Relative to the host: far from the world's origin digits would be lost.
  const Vector3d origin = views.front().T_wc.position;
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const TriangulationView& view : views) {
    const Vector3d ray = view.T_wc.rotation * view.bearing;
    const Matrix3d across = Matrix3d::Identity() - ray * ray.transpose();
    A += across;
    b += across * (view.T_wc.position - origin);
  }
  return A.ldlt().solve(b) + origin;
}

/// The landmark in (u, v, rho) about the host's bearing, and what the other views say of it.
class AnchoredPoint {
 public:
  explicit AnchoredPoint(const std::vector<TriangulationView>& views) : views_(views) {
    anchor_.bearing = views.front().bearing;
    anchor_.basis = tangentBasis(anchor_.bearing);
  }

  /// (u, v, rho) of a point that the host has before it; of the ray at `fallback` distance else.
  LandmarkParameters fromPoint(const Vector3d& position_w, double fallback) const {
    const Vector3d in_host = views_.front().T_wc.inverse() * position_w;
    const double along = in_host.dot(anchor_.bearing);
    if (!(along > 0.0) || !in_host.allFinite()) return {0.0, 0.0, 1.0 / fallback};
    const Eigen::Vector2d across = anchor_.basis.transpose() * in_host / along;
    return {across.x(), across.y(), 1.0 / along};
  }

  Vector3d position(const LandmarkParameters& landmark) const {
    return views_.front().T_wc * (anchoredDirection(anchor_, landmark) / landmark.z());
  }

  /// Normal equations of the weighted tangent-plane residuals; their squared sum is returned.
  double linearize(const LandmarkParameters& landmark, Matrix3d* H, Vector3d* g) const {
    H->setZero();
    g->setZero();
    double squares = 0.0;
    const Pose& T_wh = views_.front().T_wc;
    const Vector3d direction_w = T_wh.rotation * anchoredDirection(anchor_, landmark);
    Matrix3d J_direction;  // by (u, v, rho), in the world, but for rho's part
    J_direction.leftCols<2>() = T_wh.rotation.toRotationMatrix() * anchor_.basis;
    for (const TriangulationView& view : views_) {
      const Vector3d lever = T_wh.position - view.T_wc.position;
      J_direction.col(2) = lever;
      const Matrix3d R_cw = view.T_wc.rotation.conjugate().toRotationMatrix();
      const Vector3d in_camera = R_cw * (direction_w + landmark.z() * lever);
      const double inverse_length = 1.0 / in_camera.norm();
      const Vector3d unit = inverse_length * in_camera;
      const Eigen::Matrix<double, 3, 2> basis = tangentBasis(view.bearing);
      const Eigen::Vector2d tangent = basis.transpose() * unit;
      const Eigen::Vector2d residual = view.inverse_sigma * tangent;
      const Eigen::Matrix<double, 2, 3> J = view.inverse_sigma * inverse_length *
                                            (basis.transpose() - tangent * unit.transpose()) *
                                            (R_cw * J_direction);
      *H += J.transpose() * J;
      *g += J.transpose() * residual;
      squares += residual.squaredNorm();
    }
    return squares;
  }

  bool isBeforeAllViews(const LandmarkParameters& landmark) const {
    if (!(landmark.z() > 0.0)) return false;
    const Vector3d position_w = position(landmark);
    return std::all_of(views_.begin(), views_.end(), [&](const TriangulationView& view) {
      return (view.T_wc.rotation * view.bearing).dot(position_w - view.T_wc.position) > 0.0;
    });
  }

 private:
  const std::vector<TriangulationView>& views_;
  LandmarkAnchor anchor_;
};

/// Gauss-Newton from `landmark` on; the last normal matrix and sum of squares.
struct Refinement {
  LandmarkParameters landmark;
  Matrix3d H;
  double squares = 0.0;
};

Refinement refine(const AnchoredPoint& point, const LandmarkParameters& start, int iterations) {
  constexpr double kSmall = 1e-16;  // squared step below which nothing changes any more
  Refinement best{start, Matrix3d::Identity(), 0.0};
  Vector3d g;
  best.squares = point.linearize(start, &best.H, &g);
  for (int i = 0; i < iterations; ++i) {
    const Vector3d step = -best.H.ldlt().solve(g);
    if (!step.allFinite()) break;
    Refinement next{best.landmark + step, Matrix3d::Identity(), 0.0};
    Vector3d next_g;
    next.squares = point.linearize(next.landmark, &next.H, &next_g);
    // A full step too far: the linear start was poor, or this is the minimum.
    if (!(next.squares <= best.squares)) break;
    best = next;
    g = next_g;
    if (step.squaredNorm() < kSmall) break;
  }
  return best;
}

TriangulationStatus judge(const Triangulation& result, const TriangulationOptions& options) {
  if (result.distance < options.min_distance || result.distance > options.max_distance) {
    return TriangulationStatus::kBadDistance;
  }
  return result.rms <= options.max_rms ? TriangulationStatus::kOk
                                       : TriangulationStatus::kBadResidual;
}

}  // namespace

void TriangulationOptions::validate() const {
  requirePositive("triangulation", "min_parallax", min_parallax);
  requirePositive("triangulation", "max_rms", max_rms);
  requirePositive("triangulation", "min_distance", min_distance);
  requirePositive("triangulation", "max_distance", max_distance);
  requirePositive("triangulation", "max_iterations", max_iterations);
}

const char* toString(TriangulationStatus status) {
  switch (status) {
    case TriangulationStatus::kOk:
      return "ok";
    case TriangulationStatus::kTooFewViews:
      return "too few views";
    case TriangulationStatus::kLittleParallax:
      return "little parallax";
    case TriangulationStatus::kBehindCamera:
      return "behind a camera";
    case TriangulationStatus::kBadDistance:
      return "bad distance";
    case TriangulationStatus::kBadResidual:
      return "bad residual";
  }
  return "unknown";
}

double largestParallax(const std::vector<TriangulationView>& views) {
  return std::acos(std::clamp(smallestCosine(views), -1.0, 1.0));
}

Triangulation triangulate(const std::vector<TriangulationView>& views,
                          const TriangulationOptions& options) {
  Triangulation result;
  if (views.size() < 2) return result;
  result.parallax = largestParallax(views);
  result.status = TriangulationStatus::kLittleParallax;
  if (!(result.parallax >= options.min_parallax)) return result;

  const AnchoredPoint point(views);
  const LandmarkParameters start = point.fromPoint(nearestPoint(views), options.max_distance);
  const Refinement refined = refine(point, start, options.max_iterations);
  result.status = TriangulationStatus::kBehindCamera;
  if (!refined.landmark.allFinite() || !point.isBeforeAllViews(refined.landmark)) return result;

  result.landmark = refined.landmark;
  result.position_w = point.position(refined.landmark);
  result.distance = (result.position_w - views.front().T_wc.position).norm();
  result.rms = std::sqrt(refined.squares / (2.0 * static_cast<double>(views.size())));
  result.sigma_inverse_distance =
      std::sqrt(std::max(0.0, refined.H.ldlt().solve(Vector3d::UnitZ()).z()));
  result.status = judge(result, options);
  return result;
}

}  // namespace vins::estimator
