#include "simulation/furnishing.h"

#include <algorithm>
#include <cmath>

#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr int kTries = 30;

TextureStyle anyStyle(Random& random) {
  const TextureStyle styles[] = {TextureStyle::kClutter, TextureStyle::kClutter,
                                 TextureStyle::kPrint,   TextureStyle::kBoards,
                                 TextureStyle::kBricks,  TextureStyle::kPlaster};
  return styles[static_cast<int>(random.uniform(0.0, 6.0))];
}

Vector3d sizeBetween(Random& random, const Vector3d& smallest, const Vector3d& largest) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return smallest + Vector3d(x, y, z).cwiseProduct(largest - smallest);
}

Pose standingAt(double x, double y, double z, double yaw) {
  return {so3::exp(Vector3d(0.0, 0.0, yaw)), {x, y, z}};
}

void addBlockStack(SceneBuilder& builder, const AlignedBox3d& space, const Furniture& furniture,
                   const ReservedSpace& reserved) {
  Random& random = builder.random();
  Vector3d half = sizeBetween(random, furniture.smallest_half, furniture.largest_half);
  half.z() = std::min(half.z(), 0.45 * space.sizes().z());
  const Finish finish{anyStyle(random), furniture.texels_per_m};
  for (int i = 0; i < kTries; ++i) {
    const double yaw = random.uniform(0.0, M_PI), margin = half.head<2>().norm();
    const double x = random.uniform(space.min().x() + margin, space.max().x() - margin);
    const double y = random.uniform(space.min().y() + margin, space.max().y() - margin);
    const double floor = space.min().z();
    if (!builder.tryBlock(standingAt(x, y, floor + half.z(), yaw), half, finish, reserved)) {
      continue;
    }
    // Narrow enough to stay on top at any yaw.
    const double width = 0.65 * half.head<2>().minCoeff();
    const Vector3d top(width, width, random.uniform(0.3, 1.0) * width);
    if (random.uniform() < 0.6 && 2.0 * (half.z() + top.z()) < space.sizes().z()) {
      builder.tryBlock(standingAt(x, y, floor + 2.0 * half.z() + top.z(), yaw + 0.6), top,
                       {TextureStyle::kClutter, furniture.texels_per_m}, reserved);
    }
    return;
  }
}

void hangBoard(SceneBuilder& builder, const AlignedBox3d& space, const ReservedSpace& reserved) {
  Random& random = builder.random();
  const Vector3d half(random.uniform(0.25, 0.7), 0.015, random.uniform(0.2, 0.5));
  const AlignedBox3d inner(space.min() + Vector3d::Constant(0.8),
                           space.max() - Vector3d::Constant(0.8));
  for (int i = 0; i < kTries; ++i) {
    const Vector3d p = sizeBetween(random, inner.min(), inner.max());
    const Pose pose = standingAt(p.x(), p.y(), p.z(), random.uniform(0.0, M_PI));
    if (builder.tryBlock(pose, half, {TextureStyle::kPrint, 400.0}, reserved)) return;
  }
}

/// On one of the four walls; each a little farther off the wall than the one before, so that
/// overlapping ones do not share a plane.
void addPoster(SceneBuilder& builder, const AlignedBox3d& space, int index) {
  Random& random = builder.random();
  const double yaw = (index % 4) * M_PI_2;
  const Eigen::Quaterniond R = so3::exp(Vector3d(0.0, 0.0, yaw));
  // Facing -y before the turn.
  const Vector3d axis_s = R * Vector3d::UnitX(), normal = R * -Vector3d::UnitY();
  const Vector3d half_space = 0.5 * space.sizes();
  const double to_wall = normal.cwiseAbs().dot(half_space) - 0.01 - 0.001 * index;
  const double half_s = random.uniform(0.2, 0.6), half_t = random.uniform(0.2, 0.6);
  const double along = axis_s.cwiseAbs().dot(half_space) - half_s;
  const double up = std::max(half_space.z() - half_t, 0.0);
  Vector3d centre = space.center() - to_wall * normal;
  centre += random.uniform(-along, along) * axis_s;
  centre.z() += random.uniform(-up, up);
  const bool print = random.uniform() < 0.6;
  builder.addPanel(centre, axis_s, Vector3d::UnitZ(), half_s, half_t,
                   {print ? TextureStyle::kPrint : TextureStyle::kClutter, 400.0});
}

}  // namespace

void furnish(SceneBuilder& builder, const AlignedBox3d& space, const Furniture& furniture,
             const ReservedSpace& reserved) {
  for (int i = 0; i < furniture.blocks; ++i) addBlockStack(builder, space, furniture, reserved);
  for (int i = 0; i < furniture.boards; ++i) hangBoard(builder, space, reserved);
  for (int i = 0; i < furniture.posters; ++i) addPoster(builder, space, i);
}

void hangLamps(SceneBuilder& builder, const AlignedBox3d& space, int columns, int rows) {
  const Vector3d size = space.sizes();
  const double spacing = std::max(size.x() / columns, size.y() / rows);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const Vector3d share((column + 0.5) / columns, (row + 0.5) / rows, 0.97);
      builder.addLight(space.min() + share.cwiseProduct(size), 0.45, 0.6 * spacing);
    }
  }
}

}  // namespace vins::simulation
