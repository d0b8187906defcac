#pragma once

#include <string>

#include <Eigen/Core>

namespace vins {

/// The shortest decimal that reads back as the same double, with a point or an exponent: OpenCV's
/// storage would read a whole number as an integer.
std::string exactNumber(double value);

/// A line "KEY: !!opencv-matrix" and those that follow it, each ended, with exact numbers.
std::string opencvMatrix(const std::string& key, const Eigen::MatrixXd& matrix);

}  // namespace vins
