#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera_model/camera.h"

namespace vins::camera_model {

/// OCam polynomial camera (D. Scaramuzza, A. Martinelli, R. Siegwart, "A flexible technique for
/// accurate omnidirectional camera calibration and structure from motion", ICVS 2006), with the
/// axes and names of camodocal's files: the pixel (u, v) is [ac ad; ae 1] (x, y) + (cx, cy), and
/// the point (x, y) of the sensor sees along (x, y, -(p0 + p1 r + p2 r^2 + p3 r^3 + p4 r^4)), r =
/// |(x, y)|. The polynomial alone defines the camera; projection inverts it to rounding, where
/// OCam's second, fitted polynomial would be off by hundredths of a pixel. Parameters: p0, p1, p2,
/// p3, p4 [px^(1 - i)], ac, ad, ae [-], cx, cy [px].
class Scaramuzza : public Camera {
 public:
  Scaramuzza(const std::string& name, ImageSize size, const CameraParameters& parameters);

  CameraModel model() const override { return CameraModel::kScaramuzza; }
  using Camera::project;
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c,
                                         ProjectionJacobians* jacobians) const override;
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override;
  CameraParameters parameters() const override { return parameters_; }
  std::vector<std::string> parameterNames() const override;
  std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const override;
  std::unique_ptr<Camera> scaledTo(ImageSize size) const override;

  /// OCam's inverse polynomial, for programs that need it: r as a polynomial of `count`
  /// coefficients of the angle from the image plane atan2(-z, |(x, y)|) [rad], fitted.
  std::vector<double> fitInversePolynomial(int count) const;

 private:
  double height(double radius) const;       ///< z of the ray through `radius`
  double heightSlope(double radius) const;  ///< its derivative
  double turnRate(double radius) const;     ///< angle from the axis by radius, times |p0|
  double findMaxRadius() const;
  void fillTable();
  std::optional<double> radiusOf(double lateral, double z) const;

  CameraParameters parameters_;
  std::array<double, 5> poly_{};
  Eigen::Matrix2d affine_, affine_inverse_;
  Eigen::Vector2d center_;
  double max_radius_ = 0.0;
  double max_angle_ = 0.0;
  std::vector<double> radii_;  ///< at equally spaced angles from the axis
};

}  // namespace vins::camera_model
