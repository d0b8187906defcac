#pragma once

#include <string>

namespace vins::pipeline {

/// The folder of the shipped vocabulary and pattern: in the share of the package pose_graph beside
/// this program's own, or where ROS finds that package. Throws InputError naming where it looked.
std::string findSupportFiles();

}  // namespace vins::pipeline
