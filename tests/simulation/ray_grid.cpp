#include "simulation/ray_grid.h"

namespace vins::simulation {

RayGrid::RayGrid(const camera_model::Camera& camera)
    : width_(camera.imageSize().width),
      height_(camera.imageSize().height),
      stride_(width_ + 2),
      x_(static_cast<std::size_t>(stride_) * (height_ + 2) + kReadAhead, 0.0F),
      y_(x_),
      z_(x_) {
  for (int v = -1; v <= height_; ++v) {
    for (int u = -1; u <= width_; ++u) {
      const auto bearing = camera.unproject(Eigen::Vector2d(u, v));
      if (!bearing) continue;
      x_[index(u, v)] = static_cast<float>(bearing->x());
      y_[index(u, v)] = static_cast<float>(bearing->y());
      z_[index(u, v)] = static_cast<float>(bearing->z());
    }
  }
}

Eigen::Vector3f RayGrid::slope(int u, int v, int du, int dv) const {
  const bool ahead = isSeen(u + du, v + dv), behind = isSeen(u - du, v - dv);
  if (ahead && behind) return 0.5F * (bearing(u + du, v + dv) - bearing(u - du, v - dv));
  if (!isSeen(u, v)) return Eigen::Vector3f::Zero();
  if (ahead) return bearing(u + du, v + dv) - bearing(u, v);
  if (behind) return bearing(u, v) - bearing(u - du, v - dv);
  return Eigen::Vector3f::Zero();
}

}  // namespace vins::simulation
