#include "camera_model/double_sphere.h"

#include <cmath>

namespace vins::camera_model {

DoubleSphere::DoubleSphere(const std::string& name, ImageSize size,
                           const CameraParameters& parameters)
    : UnifiedCamera(name, size, CameraModel::kDoubleSphere, parameters) {
  requireBetween(0, "xi", -1.0, 1.0);
  requireBetween(1, "alpha", 0.0, 1.0);
}

std::unique_ptr<Camera> DoubleSphere::withParameters(const CameraParameters& parameters) const {
  return std::make_unique<DoubleSphere>(name(), imageSize(), parameters);
}

std::unique_ptr<Camera> DoubleSphere::scaledTo(ImageSize size) const {
  return std::make_unique<DoubleSphere>(name(), size, scaledParameters(size));
}

std::optional<UnifiedCamera::Denominator> DoubleSphere::denominator(
    const Eigen::Vector3d& p_c) const {
  const double xi = first(), alpha = second();
  const double range = p_c.norm();
  const double w1 = alpha <= 0.5 ? alpha / (1.0 - alpha) : (1.0 - alpha) / alpha;
  const double w2 = (w1 + xi) / std::sqrt(2.0 * w1 * xi + xi * xi + 1.0);
  if (!(p_c.z() > -w2 * range)) return std::nullopt;
  // Height and distance, seen from the centre of the second sphere.
  const double height = xi * range + p_c.z();
  const double distance = std::hypot(p_c.head<2>().norm(), height);
  Denominator n;
  n.value = alpha * distance + (1.0 - alpha) * height;
  if (!(n.value > 0.0)) return std::nullopt;
  const double by_height = alpha * height / distance + 1.0 - alpha;
  n.J_point = by_height * (xi / range * p_c.transpose() + Eigen::RowVector3d::UnitZ());
  n.J_point.head<2>() += alpha / distance * p_c.head<2>().transpose();
  n.J_parameters << by_height * range, distance - height;
  return n;
}

double DoubleSphere::marginToFold(double squared_radius) const {
  const double alpha = second();
  return alpha > 0.5 ? 1.0 - (2.0 * alpha - 1.0) * squared_radius : 1.0;
}

Eigen::Vector3d DoubleSphere::lift(const Eigen::Vector2d& m) const {
  const double xi = first(), alpha = second();
  const double s = m.squaredNorm();
  // Height over the plane, as seen from the second sphere (equation 48).
  const double z =
      (1.0 - alpha * alpha * s) / (alpha * std::sqrt(1.0 - (2.0 * alpha - 1.0) * s) + 1.0 - alpha);
  const double scale = (z * xi + std::sqrt(z * z + (1.0 - xi * xi) * s)) / (z * z + s);
  return Eigen::Vector3d(scale * m.x(), scale * m.y(), scale * z - xi).normalized();
}

}  // namespace vins::camera_model
