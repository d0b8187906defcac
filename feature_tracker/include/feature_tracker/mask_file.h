#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"

namespace vins::feature_tracker {

/// The mask image at `path`, CV_8UC1: 255 where corners may be, 0 elsewhere (brightness of at least
/// half of white counts as "may be"). Empty where `path` is empty. Throws InputError where the file
/// cannot be read, or is not of the camera's size.
cv::Mat readMaskFile(const std::string& path, camera_model::ImageSize size);

}  // namespace vins::feature_tracker
