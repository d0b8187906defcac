#pragma once

#include <string>
#include <vector>

#include "camera_model/calibration.h"

namespace vins::camera_model {

/// Cells of the image in which coverage is counted.
constexpr int kCoverageColumns = 8;
constexpr int kCoverageRows = 6;

/// Corners in use in each cell, row by row.
std::vector<int> cornersPerCell(ImageSize size, const std::vector<CalibrationView>& views,
                                const Calibration& calibration);

/// Why the result should not be trusted, a text each; none where it can be.
std::vector<std::string> weaknesses(const CalibrationOptions& options,
                                    const std::vector<CalibrationView>& views,
                                    const Calibration& calibration);

}  // namespace vins::camera_model
