#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "camera_model/radtan_distortion.h"

namespace vins::camera_model {

/// Unified omnidirectional camera: the point goes to the unit sphere, from there through a pinhole
/// xi above the sphere's centre, and through radial and tangential distortion (C. Mei, P. Rives,
/// "Single view point omnidirectional camera calibration from planar grids", ICRA 2007; OpenCV's
/// omnidir without skew, Kalibr's omni-radtan).
/// Parameters: xi [-], k1, k2, p1, p2 [-], gamma1, gamma2, u0, v0 [px].
class Mei : public Camera {
 public:
  Mei(const std::string& name, ImageSize size, const CameraParameters& parameters);

  CameraModel model() const override { return CameraModel::kMei; }
  using Camera::project;
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c,
                                         ProjectionJacobians* jacobians) const override;
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override;
  CameraParameters parameters() const override;
  std::vector<std::string> parameterNames() const override;
  std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const override;
  std::unique_ptr<Camera> scaledTo(ImageSize size) const override;

 private:
  double xi_, gamma1_, gamma2_, u0_, v0_;
  RadtanDistortion distortion_;
};

}  // namespace vins::camera_model
