#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "camera_model/radtan_distortion.h"

namespace vins::camera_model {

/// Pinhole camera with radial and tangential distortion, as OpenCV's calib3d has it.
/// Parameters: fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-]; with rational distortion (OpenCV's
/// CALIB_RATIONAL_MODEL, ROS's rational_polynomial) also k4, k5, k6 [-].
class PinholeRadtan : public Camera {
 public:
  /// Nine parameters, or twelve with rational distortion.
  PinholeRadtan(const std::string& name, ImageSize size, const CameraParameters& parameters);

  CameraModel model() const override { return CameraModel::kPinhole; }
  using Camera::project;
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c,
                                         ProjectionJacobians* jacobians) const override;
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override;
  CameraParameters parameters() const override;
  std::vector<std::string> parameterNames() const override;
  std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const override;
  std::unique_ptr<Camera> scaledTo(ImageSize size) const override;

 private:
  int count_;  ///< of parameters
  double fx_, fy_, cx_, cy_;
  RadtanDistortion distortion_;
};

}  // namespace vins::camera_model
