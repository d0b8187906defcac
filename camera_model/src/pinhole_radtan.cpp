#include "camera_model/pinhole_radtan.h"

#include <algorithm>

#include "image_plane.h"

namespace vins::camera_model {
namespace {

constexpr int kCount = 9;
constexpr int kRationalCount = 12;

int countOf(const CameraParameters& p) {
  return p.size() == kRationalCount ? kRationalCount : kCount;
}

RadtanDistortion distortionOf(const CameraParameters& p, ImageSize size) {
  if (p.size() != countOf(p)) return RadtanDistortion({}, 1.0);
  RadtanDistortion::Coefficients k{};
  std::copy(p.data() + 4, p.data() + p.size(), k.begin());
  return RadtanDistortion(k, imageReach(size, p[0], p[1], p[2], p[3]));
}

}  // namespace

PinholeRadtan::PinholeRadtan(const std::string& name, ImageSize size,
                             const CameraParameters& parameters)
    : Camera(name, size), count_(countOf(parameters)), distortion_(distortionOf(parameters, size)) {
  requireCount(model(), parameters, count_);
  requireFinite(parameters);
  fx_ = parameters[0];
  fy_ = parameters[1];
  cx_ = parameters[2];
  cy_ = parameters[3];
  requirePositive("fx", fx_);
  requirePositive("fy", fy_);
}

std::optional<Eigen::Vector2d> PinholeRadtan::project(const Eigen::Vector3d& p_c,
                                                      ProjectionJacobians* jacobians) const {
  if (!(p_c.z() > 0.0)) return std::nullopt;
  const double inverse_z = 1.0 / p_c.z();
  const Eigen::Vector2d m = p_c.head<2>() * inverse_z;
  Eigen::Matrix2d J_m;
  RadtanDistortion::Matrix28 J_k;
  const auto d = distortion_.distort(m, jacobians ? &J_m : nullptr, jacobians ? &J_k : nullptr);
  if (!d) return std::nullopt;
  if (jacobians != nullptr) {
    const Eigen::Vector2d f(fx_, fy_);
    Eigen::Matrix<double, 2, 3> J_m_point;
    J_m_point << inverse_z, 0.0, -m.x() * inverse_z, 0.0, inverse_z, -m.y() * inverse_z;
    jacobians->J_pixel_point = f.asDiagonal() * J_m * J_m_point;
    auto& J = jacobians->J_pixel_parameters;
    J.setZero(2, count_);
    J(0, 0) = d->x();
    J(1, 1) = d->y();
    J(0, 2) = J(1, 3) = 1.0;
    J.rightCols(count_ - 4) = f.asDiagonal() * J_k.leftCols(count_ - 4);
  }
  return Eigen::Vector2d(fx_ * d->x() + cx_, fy_ * d->y() + cy_);
}

std::optional<Eigen::Vector3d> PinholeRadtan::unproject(const Eigen::Vector2d& pixel) const {
  const auto m = distortion_.undistort({(pixel.x() - cx_) / fx_, (pixel.y() - cy_) / fy_});
  if (!m) return std::nullopt;
  return Eigen::Vector3d(m->x(), m->y(), 1.0).normalized();
}

CameraParameters PinholeRadtan::parameters() const {
  const auto& k = distortion_.coefficients();
  CameraParameters p(count_);
  p.head<4>() << fx_, fy_, cx_, cy_;
  std::copy_n(k.begin(), count_ - 4, p.data() + 4);
  return p;
}

std::vector<std::string> PinholeRadtan::parameterNames() const {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy", "k1", "k2",
                                    "p1", "p2", "k3", "k4", "k5", "k6"};
  names.resize(static_cast<std::size_t>(count_));
  return names;
}

std::unique_ptr<Camera> PinholeRadtan::withParameters(const CameraParameters& parameters) const {
  return std::make_unique<PinholeRadtan>(name(), imageSize(), parameters);
}

std::unique_ptr<Camera> PinholeRadtan::scaledTo(ImageSize size) const {
  const Eigen::Vector2d scale = scaleBetween(imageSize(), size);
  CameraParameters p = parameters();
  p[0] *= scale.x();
  p[1] *= scale.y();
  p[2] = scalePixel(cx_, scale.x());
  p[3] = scalePixel(cy_, scale.y());
  return std::make_unique<PinholeRadtan>(name(), size, p);
}

}  // namespace vins::camera_model
