#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/calibration.h"

namespace vins::camera_model {

/// Picture of where the corners of a calibration lie in the image: a dot each (a colour a view,
/// left-out corners crossed), and the cells of the coverage count, red where they are empty.
cv::Mat drawCoverage(ImageSize size, const std::vector<CalibrationView>& views,
                     const Calibration& calibration);

/// Picture of the residuals: at the left as arrows where they occur, magnified so that the root
/// mean square is a fortieth of the image's width; at the right as a cloud around zero with
/// circles of one, two and three root mean squares.
cv::Mat drawResiduals(ImageSize size, const std::vector<CalibrationView>& views,
                      const Calibration& calibration);

}  // namespace vins::camera_model
