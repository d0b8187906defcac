#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/unified_camera.h"

namespace vins::camera_model {

/// Extended unified camera: the point goes to an ellipsoid, of which beta is the shape, and through
/// a pinhole that alpha places (B. Khomutenko, G. Garcia, P. Martinet, "An enhanced unified camera
/// model", RA-L 2016; Kalibr's eucm-none).
/// Parameters: alpha from 0 to 1, beta above 0 [-], fx, fy, cx, cy [px].
class Eucm : public UnifiedCamera {
 public:
  Eucm(const std::string& name, ImageSize size, const CameraParameters& parameters);

  CameraModel model() const override { return CameraModel::kEucm; }
  std::vector<std::string> parameterNames() const override {
    return {"alpha", "beta", "fx", "fy", "cx", "cy"};
  }
  std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const override;
  std::unique_ptr<Camera> scaledTo(ImageSize size) const override;

 protected:
  std::optional<Denominator> denominator(const Eigen::Vector3d& p_c) const override;
  double marginToFold(double squared_radius) const override;
  Eigen::Vector3d lift(const Eigen::Vector2d& m) const override;
};

}  // namespace vins::camera_model
