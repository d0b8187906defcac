#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/unified_camera.h"

namespace vins::camera_model {

/// Double sphere camera: the point goes to a unit sphere, from there to a second one xi above the
/// first, and through a pinhole that alpha places (V. Usenko, N. Demmel, D. Cremers, "The double
/// sphere camera model", 3DV 2018, equations 40 to 53; Kalibr's ds-none, Basalt's ds).
/// Two pairs of xi and alpha, with their focal lengths, may map nearly alike: two calibrations of
/// one camera may differ in them by far and in no pixel. Parameters: xi from -1 to 1, alpha from 0
/// to 1 [-], fx, fy, cx, cy [px].
class DoubleSphere : public UnifiedCamera {
 public:
  DoubleSphere(const std::string& name, ImageSize size, const CameraParameters& parameters);

  CameraModel model() const override { return CameraModel::kDoubleSphere; }
  std::vector<std::string> parameterNames() const override {
    return {"xi", "alpha", "fx", "fy", "cx", "cy"};
  }
  std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const override;
  std::unique_ptr<Camera> scaledTo(ImageSize size) const override;

 protected:
  std::optional<Denominator> denominator(const Eigen::Vector3d& p_c) const override;
  double marginToFold(double squared_radius) const override;
  Eigen::Vector3d lift(const Eigen::Vector2d& m) const override;
};

}  // namespace vins::camera_model
