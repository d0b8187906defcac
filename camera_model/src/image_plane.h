#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "camera_model/camera.h"

namespace vins::camera_model {

/// Factors by which the pixel grid grows from one image size to another.
inline Eigen::Vector2d scaleBetween(ImageSize from, ImageSize to) {
  return {static_cast<double>(to.width) / from.width, static_cast<double>(to.height) / from.height};
}

/// Distance from the centre (cx, cy) of the outermost corner of the image's outermost pixels, in
/// units of the focal lengths; 1 where the focal lengths make no sense.
inline double imageReach(ImageSize size, double fx, double fy, double cx, double cy) {
  if (!(fx > 0.0) || !(fy > 0.0)) return 1.0;
  const double x = std::max(std::abs(-0.5 - cx), std::abs(size.width - 0.5 - cx)) / fx;
  const double y = std::max(std::abs(-0.5 - cy), std::abs(size.height - 0.5 - cy)) / fy;
  const double reach = std::hypot(x, y);
  return std::isfinite(reach) ? reach : 1.0;
}

/// A pixel coordinate after resizing by `scale`: pixel centres are whole numbers, so the image
/// begins at -1/2.
inline double scalePixel(double coordinate, double scale) {
  return (coordinate + 0.5) * scale - 0.5;
}

}  // namespace vins::camera_model
