#include "camera_model/eucm.h"

#include <cmath>

namespace vins::camera_model {

Eucm::Eucm(const std::string& name, ImageSize size, const CameraParameters& parameters)
    : UnifiedCamera(name, size, CameraModel::kEucm, parameters) {
  requireBetween(0, "alpha", 0.0, 1.0);
  requirePositive("beta", parameters[1]);
}

std::unique_ptr<Camera> Eucm::withParameters(const CameraParameters& parameters) const {
  return std::make_unique<Eucm>(name(), imageSize(), parameters);
}

std::unique_ptr<Camera> Eucm::scaledTo(ImageSize size) const {
  return std::make_unique<Eucm>(name(), size, scaledParameters(size));
}

std::optional<UnifiedCamera::Denominator> Eucm::denominator(const Eigen::Vector3d& p_c) const {
  const double alpha = first(), beta = second();
  const double squared_side = p_c.head<2>().squaredNorm();
  const double distance = std::sqrt(beta * squared_side + p_c.z() * p_c.z());
  const double w = alpha <= 0.5 ? alpha / (1.0 - alpha) : (1.0 - alpha) / alpha;
  if (!(p_c.z() > -w * distance)) return std::nullopt;
  Denominator n;
  n.value = alpha * distance + (1.0 - alpha) * p_c.z();
  if (!(n.value > 0.0)) return std::nullopt;
  n.J_point << alpha * beta / distance * p_c.head<2>().transpose(),
      alpha * p_c.z() / distance + 1.0 - alpha;
  n.J_parameters << distance - p_c.z(), 0.5 * alpha * squared_side / distance;
  return n;
}

double Eucm::marginToFold(double squared_radius) const {
  const double alpha = first();
  return alpha > 0.5 ? 1.0 - (2.0 * alpha - 1.0) * second() * squared_radius : 1.0;
}

Eigen::Vector3d Eucm::lift(const Eigen::Vector2d& m) const {
  const double alpha = first(), beta = second();
  const double s = beta * m.squaredNorm();
  const double z =
      (1.0 - alpha * alpha * s) / (alpha * std::sqrt(1.0 - (2.0 * alpha - 1.0) * s) + 1.0 - alpha);
  return Eigen::Vector3d(m.x(), m.y(), z).normalized();
}

}  // namespace vins::camera_model
