#pragma once

#include <vector>

#include <Eigen/Core>

#include "camera_model/camera.h"

namespace vins::simulation {

/// The unit bearings of all pixels of a camera, with one more pixel around the image, as floats:
/// 6e-8 rad, which is below 1e-3 px for any lens. Where the camera has no bearing it is zero.
class RayGrid {
 public:
  explicit RayGrid(const camera_model::Camera& camera);

  int width() const { return width_; }
  int height() const { return height_; }

  /// As many bearings may be read from any pixel on, though they run into the next row.
  static constexpr int kReadAhead = 32;

  /// Coordinates of the bearings from pixel (u, v) on, along the row; u and v from -1 on.
  const float* x(int u, int v) const { return x_.data() + index(u, v); }
  const float* y(int u, int v) const { return y_.data() + index(u, v); }
  const float* z(int u, int v) const { return z_.data() + index(u, v); }

  Eigen::Vector3f bearing(int u, int v) const { return {*x(u, v), *y(u, v), *z(u, v)}; }
  bool isSeen(int u, int v) const { return !bearing(u, v).isZero(0.0F); }

  /// Change of the bearing per pixel to the right, or downwards. Zero at the edge of what is seen.
  Eigen::Vector3f perColumn(int u, int v) const { return slope(u, v, 1, 0); }
  Eigen::Vector3f perRow(int u, int v) const { return slope(u, v, 0, 1); }

 private:
  int index(int u, int v) const { return (v + 1) * stride_ + u + 1; }
  Eigen::Vector3f slope(int u, int v, int du, int dv) const;

  int width_;
  int height_;
  int stride_;
  std::vector<float> x_, y_, z_;
};

}  // namespace vins::simulation
