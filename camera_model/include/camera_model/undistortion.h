#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "camera_model/camera.h"

namespace vins::camera_model {

/// Where to look for each pixel of an undistorted (and perhaps turned) pinhole image: two maps of
/// CV_32FC1 for cv::remap. Pixels that the camera does not see map to (-1, -1).
struct UndistortionMap {
  cv::Mat map_x;
  cv::Mat map_y;
};

/// Map for an ideal pinhole of the intrinsic matrix `K` (3x3, [px]) and this size, whose frame v is
/// turned against the camera's by R_cv: the ray of pixel x goes to R_cv K^-1 (x, 1).
UndistortionMap makeUndistortionMap(const Camera& camera, const Eigen::Matrix3d& K, ImageSize size,
                                    const Eigen::Matrix3d& R_cv = Eigen::Matrix3d::Identity());

}  // namespace vins::camera_model
