#include "camera_model/kannala_brandt.h"

#include <cmath>

#include "image_plane.h"

namespace vins::camera_model {
namespace {

constexpr int kCount = 8;
/// Straight behind the camera every direction of the image plane meets in one bearing.
constexpr double kMaxAngle = 0.99 * M_PI;
/// Closer to the axis than this share of the depth, the map is linear to double precision.
constexpr double kOnAxis = 1e-9;

RadialDistortion polynomialOf(const CameraParameters& p, ImageSize size) {
  if (p.size() != kCount) return RadialDistortion({}, kMaxAngle, 1.0);
  return RadialDistortion({p[0], p[1], p[2], p[3]}, kMaxAngle,
                          imageReach(size, p[4], p[5], p[6], p[7]));
}

/// Derivatives of the distorted point d = (radius(t) / r) (x, y), with r = |(x, y)|, t = atan2(r,
/// z).
Eigen::Matrix<double, 2, 3> distortedByPoint(const Eigen::Vector3d& p_c, double r, double radius,
                                             double slope) {
  Eigen::Matrix<double, 2, 3> J;
  if (r <= kOnAxis * p_c.z()) {
    J << 1.0 / p_c.z(), 0.0, 0.0, 0.0, 1.0 / p_c.z(), 0.0;
    return J;
  }
  const Eigen::Vector2d u = p_c.head<2>() / r;
  const double squared_range = p_c.squaredNorm();
  const double along = slope * p_c.z() / squared_range;  // by r
  const double across = radius / r;                      // by the direction, times 1 / r
  J.leftCols<2>() =
      along * u * u.transpose() + across * (Eigen::Matrix2d::Identity() - u * u.transpose());
  J.col(2) = -slope * r / squared_range * u;
  return J;
}

}  // namespace

KannalaBrandt::KannalaBrandt(const std::string& name, ImageSize size,
                             const CameraParameters& parameters)
    : Camera(name, size), parameters_(parameters), radial_(polynomialOf(parameters, size)) {
  requireCount(model(), parameters, kCount);
  requireFinite(parameters);
  mu_ = parameters[4];
  mv_ = parameters[5];
  u0_ = parameters[6];
  v0_ = parameters[7];
  requirePositive("mu", mu_);
  requirePositive("mv", mv_);
}

std::optional<Eigen::Vector2d> KannalaBrandt::project(const Eigen::Vector3d& p_c,
                                                      ProjectionJacobians* jacobians) const {
  const double r = p_c.head<2>().norm();
  const double angle = std::atan2(r, p_c.z());
  if (!(angle <= radial_.maxRadius()) || (r == 0.0 && p_c.z() <= 0.0)) return std::nullopt;
  const double s = angle * angle;
  const double radius = angle * radial_.ratio(s);
  const double scale = r <= kOnAxis * p_c.z() ? 1.0 / p_c.z() : radius / r;
  const Eigen::Vector2d d = scale * p_c.head<2>();
  if (jacobians != nullptr) {
    const Eigen::Vector2d f(mu_, mv_);
    jacobians->J_pixel_point = f.asDiagonal() * distortedByPoint(p_c, r, radius, radial_.slope(s));
    auto& J = jacobians->J_pixel_parameters;
    J.setZero(2, kCount);
    Eigen::Vector2d by_coefficient = f.cwiseProduct(d) / radial_.ratio(s);
    for (int i = 0; i < 4; ++i) J.col(i) = by_coefficient *= s;
    J(0, 4) = d.x();
    J(1, 5) = d.y();
    J(0, 6) = J(1, 7) = 1.0;
  }
  return Eigen::Vector2d(mu_ * d.x() + u0_, mv_ * d.y() + v0_);
}

std::optional<Eigen::Vector3d> KannalaBrandt::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d d((pixel.x() - u0_) / mu_, (pixel.y() - v0_) / mv_);
  const double radius = d.norm();
  const std::optional<double> angle = radial_.invert(radius);
  if (!angle) return std::nullopt;
  const double share = radius > 0.0 ? std::sin(*angle) / radius : 0.0;
  return Eigen::Vector3d(share * d.x(), share * d.y(), std::cos(*angle));
}

std::vector<std::string> KannalaBrandt::parameterNames() const {
  return {"k2", "k3", "k4", "k5", "mu", "mv", "u0", "v0"};
}

std::unique_ptr<Camera> KannalaBrandt::withParameters(const CameraParameters& parameters) const {
  return std::make_unique<KannalaBrandt>(name(), imageSize(), parameters);
}

std::unique_ptr<Camera> KannalaBrandt::scaledTo(ImageSize size) const {
  const Eigen::Vector2d scale = scaleBetween(imageSize(), size);
  CameraParameters p = parameters_;
  p[4] *= scale.x();
  p[5] *= scale.y();
  p[6] = scalePixel(u0_, scale.x());
  p[7] = scalePixel(v0_, scale.y());
  return std::make_unique<KannalaBrandt>(name(), size, p);
}

}  // namespace vins::camera_model
