#include "camera_model/unified_camera.h"

#include "image_plane.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr int kCount = 6;
/// Nearer to the fold than this a pixel of noise would be many pixels of direction.
constexpr double kFoldMargin = 0.02;
/// Radius on the plane from which on pixels tell next to nothing of the direction.
constexpr double kMaxRadius = 50.0;
constexpr double kEdgeSlack = 1e-9;

}  // namespace

UnifiedCamera::UnifiedCamera(const std::string& name, ImageSize size, CameraModel model,
                             const CameraParameters& parameters)
    : Camera(name, size), parameters_(parameters) {
  requireCount(model, parameters, kCount);
  requireFinite(parameters);
  requirePositive("fx", parameters[2]);
  requirePositive("fy", parameters[3]);
}

void UnifiedCamera::requireBetween(int index, const char* parameter, double min, double max) const {
  if (parameters_[index] >= min && parameters_[index] <= max) return;
  throw InputError("camera '" + name() + "': " + parameter + ": found " +
                   std::to_string(parameters_[index]) + "; allowed: a number from " +
                   std::to_string(min) + " to " + std::to_string(max));
}

bool UnifiedCamera::isSharp(double squared_radius, double slack) const {
  return squared_radius <= kMaxRadius * kMaxRadius * (1.0 + slack) &&
         marginToFold(squared_radius) >= kFoldMargin * kFoldMargin * (1.0 - slack);
}

std::optional<Eigen::Vector2d> UnifiedCamera::project(const Eigen::Vector3d& p_c,
                                                      ProjectionJacobians* jacobians) const {
  const std::optional<Denominator> n = denominator(p_c);
  if (!n || !(n->value > 0.0)) return std::nullopt;
  const Eigen::Vector2d m = p_c.head<2>() / n->value;
  if (!isSharp(m.squaredNorm(), 0.0)) return std::nullopt;
  const Eigen::Vector2d f = parameters_.segment<2>(2);
  if (jacobians != nullptr) {
    Eigen::Matrix<double, 2, 3> J_m_point = -m * n->J_point;
    J_m_point.leftCols<2>() += Eigen::Matrix2d::Identity();
    jacobians->J_pixel_point = f.asDiagonal() * J_m_point / n->value;
    auto& J = jacobians->J_pixel_parameters;
    J.setZero(2, kCount);
    J.leftCols<2>() = f.cwiseProduct(-m / n->value) * n->J_parameters;
    J(0, 2) = m.x();
    J(1, 3) = m.y();
    J(0, 4) = J(1, 5) = 1.0;
  }
  return Eigen::Vector2d(f.cwiseProduct(m) + parameters_.tail<2>());
}

std::optional<Eigen::Vector3d> UnifiedCamera::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d m =
      (pixel - parameters_.tail<2>()).cwiseQuotient(parameters_.segment<2>(2));
  if (!isSharp(m.squaredNorm(), kEdgeSlack)) return std::nullopt;
  return lift(m);
}

CameraParameters UnifiedCamera::scaledParameters(ImageSize size) const {
  const Eigen::Vector2d scale = scaleBetween(imageSize(), size);
  CameraParameters p = parameters_;
  p[2] *= scale.x();
  p[3] *= scale.y();
  p[4] = scalePixel(p[4], scale.x());
  p[5] = scalePixel(p[5], scale.y());
  return p;
}

}  // namespace vins::camera_model
