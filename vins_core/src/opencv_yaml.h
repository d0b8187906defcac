#pragma once

#include <string>
#include <vector>

namespace vins {

/// Rewrites text that cv::FileStorage reads into YAML that means the same: "%YAML:1.0" at its top,
/// "key:value" without a space after the colon, "0.08# noise" without a space before the comment.
/// Lines keep their numbers. Appends to `repairs`, by line, what was changed; the directive, which
/// every file of OpenCV has, is not counted.
std::string standardYaml(const std::string& text, std::vector<std::string>* repairs);

}  // namespace vins
