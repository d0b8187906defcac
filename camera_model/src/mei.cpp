#include "camera_model/mei.h"

#include <cmath>

#include "image_plane.h"

namespace vins::camera_model {
namespace {

constexpr int kCount = 9;
/// For xi > 1 the map of bearings to the plane folds over where (1 + xi z) / (z + xi) is zero;
/// nearer to the fold than this a pixel of noise would be many pixels of direction.
constexpr double kFoldMargin = 0.02;

RadtanDistortion distortionOf(const CameraParameters& p, ImageSize size) {
  if (p.size() != kCount) return RadtanDistortion({}, 1.0);
  return RadtanDistortion({p[1], p[2], p[3], p[4]}, imageReach(size, p[5], p[6], p[7], p[8]));
}

}  // namespace

Mei::Mei(const std::string& name, ImageSize size, const CameraParameters& parameters)
    : Camera(name, size), distortion_(distortionOf(parameters, size)) {
  requireCount(model(), parameters, kCount);
  requireFinite(parameters);
  xi_ = parameters[0];
  gamma1_ = parameters[5];
  gamma2_ = parameters[6];
  u0_ = parameters[7];
  v0_ = parameters[8];
  requirePositive("gamma1", gamma1_);
  requirePositive("gamma2", gamma2_);
  if (xi_ < 0.0) requirePositive("xi", xi_);
}

std::optional<Eigen::Vector2d> Mei::project(const Eigen::Vector3d& p_c,
                                            ProjectionJacobians* jacobians) const {
  const double range = p_c.norm();
  const double depth = p_c.z() + xi_ * range;
  if (!(depth > 0.0) || range + xi_ * p_c.z() < kFoldMargin * depth) return std::nullopt;
  const Eigen::Vector2d m = p_c.head<2>() / depth;
  Eigen::Matrix2d J_m;
  RadtanDistortion::Matrix28 J_k;
  const auto d = distortion_.distort(m, jacobians ? &J_m : nullptr, jacobians ? &J_k : nullptr);
  if (!d) return std::nullopt;
  if (jacobians != nullptr) {
    const Eigen::Vector2d f(gamma1_, gamma2_);
    const Eigen::Matrix2d J_pixel_m = f.asDiagonal() * J_m;
    const Eigen::RowVector3d J_depth =
        Eigen::RowVector3d::UnitZ() + (xi_ / range) * p_c.transpose();
    Eigen::Matrix<double, 2, 3> J_m_point = -m * J_depth;
    J_m_point.leftCols<2>() += Eigen::Matrix2d::Identity();
    jacobians->J_pixel_point = J_pixel_m * J_m_point / depth;
    auto& J = jacobians->J_pixel_parameters;
    J.setZero(2, kCount);
    J.col(0) = J_pixel_m * (-range / depth * m);
    J.middleCols<4>(1) = f.asDiagonal() * J_k.leftCols<4>();
    J(0, 5) = d->x();
    J(1, 6) = d->y();
    J(0, 7) = J(1, 8) = 1.0;
  }
  return Eigen::Vector2d(gamma1_ * d->x() + u0_, gamma2_ * d->y() + v0_);
}

std::optional<Eigen::Vector3d> Mei::unproject(const Eigen::Vector2d& pixel) const {
  const auto m = distortion_.undistort({(pixel.x() - u0_) / gamma1_, (pixel.y() - v0_) / gamma2_});
  if (!m) return std::nullopt;
  const double s = m->squaredNorm();
  const double squared_margin = 1.0 + (1.0 - xi_ * xi_) * s;
  // The same fold as in project(), seen from the plane; the slack lets its very edge through.
  if (xi_ > 1.0 && squared_margin < kFoldMargin * kFoldMargin * (1.0 - 1e-9)) return std::nullopt;
  const double lift = (xi_ + std::sqrt(squared_margin)) / (1.0 + s);
  // Of unit length up to rounding: one Newton step for 1 / norm replaces a root and a division.
  const Eigen::Vector3d bearing(lift * m->x(), lift * m->y(), lift - xi_);
  return (1.5 - 0.5 * bearing.squaredNorm()) * bearing;
}

CameraParameters Mei::parameters() const {
  const auto& k = distortion_.coefficients();
  CameraParameters p(kCount);
  p << xi_, k[0], k[1], k[2], k[3], gamma1_, gamma2_, u0_, v0_;
  return p;
}

std::vector<std::string> Mei::parameterNames() const {
  return {"xi", "k1", "k2", "p1", "p2", "gamma1", "gamma2", "u0", "v0"};
}

std::unique_ptr<Camera> Mei::withParameters(const CameraParameters& parameters) const {
  return std::make_unique<Mei>(name(), imageSize(), parameters);
}

std::unique_ptr<Camera> Mei::scaledTo(ImageSize size) const {
  const Eigen::Vector2d scale = scaleBetween(imageSize(), size);
  CameraParameters p = parameters();
  p[5] *= scale.x();
  p[6] *= scale.y();
  p[7] = scalePixel(u0_, scale.x());
  p[8] = scalePixel(v0_, scale.y());
  return std::make_unique<Mei>(name(), size, p);
}

}  // namespace vins::camera_model
