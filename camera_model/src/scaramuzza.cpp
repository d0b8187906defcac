#include "camera_model/scaramuzza.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>

#include "image_plane.h"

namespace vins::camera_model {
namespace {

constexpr int kCount = 10;
constexpr int kNodes = 257;
constexpr int kMaxNewtonSteps = 8;
/// The same bound as for radial polynomials: below it the map of angles to radii folds over.
constexpr double kMinTurnRate = 0.02;
/// Closer to the axis than this share of the depth, the map is linear to double precision.
constexpr double kOnAxis = 1e-9;

}  // namespace

Scaramuzza::Scaramuzza(const std::string& name, ImageSize size, const CameraParameters& parameters)
    : Camera(name, size), parameters_(parameters) {
  requireCount(model(), parameters, kCount);
  requireFinite(parameters);
  std::copy_n(parameters.data(), 5, poly_.begin());
  requirePositive("-p0", -poly_[0]);
  affine_ << parameters[5], parameters[6], parameters[7], 1.0;
  requirePositive("ac - ad ae", affine_.determinant());
  affine_inverse_ = affine_.inverse();
  center_ = parameters.tail<2>();
  max_radius_ = findMaxRadius();
  max_angle_ = std::atan2(max_radius_, height(max_radius_));
  fillTable();
}

double Scaramuzza::height(double r) const {
  return -(poly_[0] + r * (poly_[1] + r * (poly_[2] + r * (poly_[3] + r * poly_[4]))));
}

double Scaramuzza::heightSlope(double r) const {
  return -(poly_[1] + r * (2.0 * poly_[2] + r * (3.0 * poly_[3] + r * 4.0 * poly_[4])));
}

double Scaramuzza::turnRate(double r) const {
  const double z = height(r);
  return -poly_[0] * (z - r * heightSlope(r)) / (r * r + z * z);
}

double Scaramuzza::findMaxRadius() const {
  // Twice the image's diagonal is beyond every pixel, wherever the centre lies in the image.
  const double limit = 2.0 * std::hypot(imageSize().width, imageSize().height);
  double inside = 0.0;
  for (double outside = 1.0; inside < limit; outside += 1.0) {
    if (turnRate(outside) < kMinTurnRate) {
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + outside);
        (turnRate(middle) < kMinTurnRate ? outside : inside) = middle;
      }
      return inside;
    }
    inside = outside;
  }
  return inside;
}

void Scaramuzza::fillTable() {
  radii_.resize(kNodes);
  for (int i = 0; i < kNodes; ++i) {
    const double angle = max_angle_ * i / (kNodes - 1);
    double low = 0.0;
    double high = max_radius_;
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (std::atan2(middle, height(middle)) < angle ? low : high) = middle;
    }
    radii_[i] = 0.5 * (low + high);
  }
}

/// Radius whose ray has the direction (lateral, z), of unit length.
std::optional<double> Scaramuzza::radiusOf(double lateral, double z) const {
  const double angle = std::atan2(lateral, z);
  if (!(angle <= max_angle_ * (1.0 + 1e-12))) return std::nullopt;
  const double position = std::min(angle / max_angle_ * (kNodes - 1), kNodes - 1.0);
  const int i = std::min(static_cast<int>(position), kNodes - 2);
  double r = radii_[i] + (position - i) * (radii_[i + 1] - radii_[i]);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const double change = -(lateral * height(r) - z * r) / (lateral * heightSlope(r) - z);
    r += change;
    // Newton squares the relative error: after a step this small none is left.
    if (std::abs(change) <= 1e-9 * r) break;
  }
  return r;
}

std::optional<Eigen::Vector2d> Scaramuzza::project(const Eigen::Vector3d& p_c,
                                                   ProjectionJacobians* jacobians) const {
  const double range = p_c.norm();
  if (!(range > 0.0)) return std::nullopt;
  const Eigen::Vector3d b = p_c / range;
  const double lateral = b.head<2>().norm();
  const std::optional<double> radius = radiusOf(lateral, b.z());
  if (!radius) return std::nullopt;
  const double r = *radius;
  const bool on_axis = lateral <= kOnAxis * b.z();
  const double scale = on_axis ? height(0.0) / b.z() : r / lateral;
  const Eigen::Vector2d x = scale * b.head<2>();
  if (jacobians != nullptr) {
    // r solves h = lateral z(r) - b_z r = 0; its derivatives are those of the implicit function.
    const double h_r = lateral * heightSlope(r) - b.z();
    const Eigen::Vector2d u = lateral > 0.0 ? Eigen::Vector2d(b.head<2>() / lateral)
                                            : Eigen::Vector2d(Eigen::Vector2d::Zero());
    Eigen::Matrix<double, 2, 3> J_x_b;
    J_x_b.leftCols<2>() = scale * (Eigen::Matrix2d::Identity() - u * u.transpose()) -
                          height(r) / h_r * u * u.transpose();
    J_x_b.col(2) = r / h_r * u;
    // b is p_c of unit length, and x depends on its direction only.
    jacobians->J_pixel_point = affine_ * J_x_b / range;
    auto& J = jacobians->J_pixel_parameters;
    J.setZero(2, kCount);
    double power = lateral / h_r;
    for (int i = 0; i < 5; ++i, power *= r) J.col(i) = affine_ * (power * u);
    J(0, 5) = x.x();
    J(0, 6) = x.y();
    J(1, 7) = x.x();
    J(0, 8) = J(1, 9) = 1.0;
  }
  return Eigen::Vector2d(affine_ * x + center_);
}

std::optional<Eigen::Vector3d> Scaramuzza::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d x = affine_inverse_ * (pixel - center_);
  const double r = x.norm();
  if (!(r <= max_radius_ * (1.0 + 1e-12))) return std::nullopt;
  return Eigen::Vector3d(x.x(), x.y(), height(r)).normalized();
}

std::vector<std::string> Scaramuzza::parameterNames() const {
  return {"p0", "p1", "p2", "p3", "p4", "ac", "ad", "ae", "cx", "cy"};
}

std::unique_ptr<Camera> Scaramuzza::withParameters(const CameraParameters& parameters) const {
  return std::make_unique<Scaramuzza>(name(), imageSize(), parameters);
}

std::unique_ptr<Camera> Scaramuzza::scaledTo(ImageSize size) const {
  const Eigen::Vector2d scale = scaleBetween(imageSize(), size);
  CameraParameters p = parameters_;
  // Radii grow with the rows; a row's own stretch goes into the affine part.
  for (int i = 0; i < 5; ++i) p[i] *= std::pow(scale.y(), 1 - i);
  p[5] *= scale.x() / scale.y();
  p[6] *= scale.x() / scale.y();
  p[8] = scalePixel(center_.x(), scale.x());
  p[9] = scalePixel(center_.y(), scale.y());
  return std::make_unique<Scaramuzza>(name(), size, p);
}

std::vector<double> Scaramuzza::fitInversePolynomial(int count) const {
  // Only radii inside of the image matter to who reads the polynomial.
  const double diagonal = std::hypot(imageSize().width, imageSize().height);
  const double last = std::min(max_radius_, 0.6 * diagonal);
  constexpr int kSamples = 400;
  Eigen::MatrixXd A(kSamples, count);
  Eigen::VectorXd r(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    r[i] = last * i / (kSamples - 1);
    const double angle = std::atan2(-height(r[i]), r[i]);
    A(i, 0) = 1.0;
    for (int j = 1; j < count; ++j) A(i, j) = A(i, j - 1) * angle;
  }
  const Eigen::VectorXd c = A.colPivHouseholderQr().solve(r);
  return {c.data(), c.data() + c.size()};
}

}  // namespace vins::camera_model
