#include "simulation/closed_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vins::simulation {
namespace {

constexpr int kPoints = 20000;

std::vector<Eigen::Vector3d> sampleCurve(const std::function<Eigen::Vector3d(double)>& curve) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(kPoints + 1);
  for (int i = 0; i < kPoints; ++i) points.push_back(curve(static_cast<double>(i) / kPoints));
  points.push_back(points.front());
  return points;
}

}  // namespace

ClosedPath::ClosedPath(const std::function<Eigen::Vector3d(double share)>& curve)
    : ClosedPath(sampleCurve(curve)) {}

ClosedPath::ClosedPath(std::vector<Eigen::Vector3d> points) : points_(std::move(points)) {
  lengths_.push_back(0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
  }
}

Eigen::Vector3d ClosedPath::at(double length) const {
  const double along = length - this->length() * std::floor(length / this->length());
  const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, along);
  const auto i = static_cast<std::size_t>(after - lengths_.begin());
  const double share = (along - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
  return points_[i - 1] + share * (points_[i] - points_[i - 1]);
}

ClosedPath ClosedPath::scaledBy(double factor) const {
  std::vector<Eigen::Vector3d> points = points_;
  const Eigen::Vector3d centre(0.0, 0.0, points.front().z());
  for (Eigen::Vector3d& point : points) point = centre + factor * (point - centre);
  return ClosedPath(std::move(points));
}

ClosedPath roundedRectangle(double half_x, double half_y, double radius, double height) {
  const double straight_x = half_x - radius, straight_y = half_y - radius;
  const double quarter = 0.5 * M_PI * radius;
  const double half_round = 2.0 * (straight_x + straight_y + quarter);
  // One quarter of the way at a time: half a side along x, a corner, half a side along y.
  const auto firstQuarter = [=](double along) -> Eigen::Vector2d {
    if (along < straight_x) return {along, -half_y};
    if (along < straight_x + quarter) {
      const double angle = (along - straight_x) / radius;
      return {straight_x + radius * std::sin(angle), -straight_y - radius * std::cos(angle)};
    }
    return {half_x, along - straight_x - quarter - straight_y};
  };
  return ClosedPath([=](double share) -> Eigen::Vector3d {
    const double turned = share < 0.5 ? share : share - 0.5;
    const double sign = share < 0.5 ? 1.0 : -1.0;
    const double along = 2.0 * turned * half_round;
    Eigen::Vector2d p;
    if (along <= 0.5 * half_round) {
      p = firstQuarter(along);
    } else {
      // The second quarter is the first one backwards, mirrored at the x axis.
      p = firstQuarter(half_round - along);
      p.y() = -p.y();
    }
    return {sign * p.x(), sign * p.y(), height};
  });
}

}  // namespace vins::simulation
