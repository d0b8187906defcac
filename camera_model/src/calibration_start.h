#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "camera_model/calibration.h"

namespace vins::camera_model {

/// Cameras of the model without distortion, for a range of focal lengths, centred in the image.
std::vector<std::unique_ptr<Camera>> startingCameras(const CalibrationOptions& options);

/// Pose T_cb of a flat board of which `points` (z = 0) are seen along `bearings`: the homography
/// between the board and the unit sphere by direct linear transformation, and its nearest rotation.
/// Nothing where the points do not determine it.
std::optional<Pose> planarPose(const std::vector<Eigen::Vector3d>& points,
                               const std::vector<Eigen::Vector3d>& bearings);

/// planarPose() of a view through a camera; nothing where the camera does not see all its corners.
std::optional<Pose> poseOfView(const Camera& camera, const std::vector<Eigen::Vector3d>& points,
                               const std::vector<Eigen::Vector2d>& corners);

}  // namespace vins::camera_model
