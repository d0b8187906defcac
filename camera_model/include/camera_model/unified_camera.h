#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera_model/camera.h"

namespace vins::camera_model {

/// What the camera models of the unified family share: a point p_c goes to
/// (fx x / n + cx, fy y / n + cy), where n, of the dimension of a length, is the model's own. Each
/// has two parameters of its own, then fx, fy, cx, cy [px]. Wide lenses without distortion
/// coefficients (V. Usenko, N. Demmel, D. Cremers, "The double sphere camera model", 3DV 2018).
class UnifiedCamera : public Camera {
 public:
  using Camera::project;
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c,
                                         ProjectionJacobians* jacobians) const override;
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override;
  CameraParameters parameters() const override { return parameters_; }

 protected:
  /// n of a point, and its derivatives.
  struct Denominator {
    double value = 0.0;
    Eigen::RowVector3d J_point;       ///< by the point
    Eigen::RowVector2d J_parameters;  ///< by the two parameters of the model
  };

  /// Throws InputError for another number of parameters or a focal length that is not positive.
  UnifiedCamera(const std::string& name, ImageSize size, CameraModel model,
                const CameraParameters& parameters);

  /// Throws InputError where parameter `index` is outside of [min, max].
  void requireBetween(int index, const char* parameter, double min, double max) const;

  /// parameters() on an image of another size.
  CameraParameters scaledParameters(ImageSize size) const;

  double first() const { return parameters_[0]; }
  double second() const { return parameters_[1]; }

  /// n and its derivatives; nothing where the point is beyond the fold of the model's map.
  virtual std::optional<Denominator> denominator(const Eigen::Vector3d& p_c) const = 0;

  /// Share of the radius m of the image plane that is left to the fold, as 1 - c m^2; 1 where the
  /// map has no fold. `squared_radius` is m^2.
  virtual double marginToFold(double squared_radius) const = 0;

  /// The unit bearing of a point of the plane that is before the fold.
  virtual Eigen::Vector3d lift(const Eigen::Vector2d& m) const = 0;

 private:
  /// `slack` lets rounding pass.
  bool isSharp(double squared_radius, double slack) const;

  CameraParameters parameters_;
};

}  // namespace vins::camera_model
