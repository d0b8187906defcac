#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "camera_model/radial_distortion.h"

namespace vins::camera_model {

/// Equidistant fisheye camera: a ray at the angle t from the axis falls at the distance
/// f (t + k2 t^3 + k3 t^5 + k4 t^7 + k5 t^9) from the centre (J. Kannala, S. Brandt, "A generic
/// camera model and calibration method for conventional, wide-angle, and fish-eye lenses", PAMI
/// 2006; OpenCV's fisheye and Kalibr's equidistant model with their k1..k4 named k2..k5 here, as
/// configuration files have it). Parameters: k2, k3, k4, k5 [-], mu, mv, u0, v0 [px].
class KannalaBrandt : public Camera {
 public:
  KannalaBrandt(const std::string& name, ImageSize size, const CameraParameters& parameters);

  CameraModel model() const override { return CameraModel::kKannalaBrandt; }
  using Camera::project;
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c,
                                         ProjectionJacobians* jacobians) const override;
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override;
  CameraParameters parameters() const override { return parameters_; }
  std::vector<std::string> parameterNames() const override;
  std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const override;
  std::unique_ptr<Camera> scaledTo(ImageSize size) const override;

 private:
  CameraParameters parameters_;
  double mu_, mv_, u0_, v0_;
  RadialDistortion radial_;  ///< of the angle from the axis [rad]
};

}  // namespace vins::camera_model
