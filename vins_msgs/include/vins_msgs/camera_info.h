#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "camera_model/opencv_intrinsics.h"
#include "vins_core/input_error.h"

namespace vins_msgs {

/// The camera of the images that a message of `topic` belongs to, by K and D: the images as the
/// sensor gives them, not rectified. A region of interest and binning are taken into account.
/// Throws InputError naming the topic, what was found and what is allowed (see makeCamera()).
inline std::unique_ptr<vins::camera_model::Camera> cameraOf(const sensor_msgs::CameraInfo& info,
                                                            const std::string& topic) {
  using vins::camera_model::ImageSize;
  vins::camera_model::OpencvIntrinsics intrinsics;
  intrinsics.distortion_model = info.distortion_model;
  // A region of zeros stands for the whole sensor.
  const bool has_region = info.roi.width > 0 && info.roi.height > 0;
  intrinsics.size =
      has_region ? ImageSize{static_cast<int>(info.roi.width), static_cast<int>(info.roi.height)}
                 : ImageSize{static_cast<int>(info.width), static_cast<int>(info.height)};
  intrinsics.fx = info.K[0];
  intrinsics.fy = info.K[4];
  intrinsics.cx = info.K[2] - info.roi.x_offset;
  intrinsics.cy = info.K[5] - info.roi.y_offset;
  intrinsics.coefficients.assign(info.D.begin(), info.D.end());
  const int columns = std::max<int>(1, static_cast<int>(info.binning_x));
  const int rows = std::max<int>(1, static_cast<int>(info.binning_y));
  try {
    auto camera = vins::camera_model::makeCamera(intrinsics, "camera");
    if (columns == 1 && rows == 1) return camera;
    return camera->scaledTo({intrinsics.size.width / columns, intrinsics.size.height / rows});
  } catch (const vins::InputError& error) {
    throw vins::InputError(topic + ": camera_info: " + error.what());
  }
}

}  // namespace vins_msgs
