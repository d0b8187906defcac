#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace vins::simulation {

/// A closed curve by its arc length.
class ClosedPath {
 public:
  /// `curve` gives a point [m] for each share of the way round in [0, 1]; its speed needs not be
  /// uniform.
  explicit ClosedPath(const std::function<Eigen::Vector3d(double share)>& curve);

  /// Once round [m].
  double length() const { return lengths_.back(); }

  /// The point at `length` [m] from the start, of any sign and size.
  Eigen::Vector3d at(double length) const;

  /// The curve, made larger by `factor` about the z axis at the height of its first point.
  ClosedPath scaledBy(double factor) const;

 private:
  explicit ClosedPath(std::vector<Eigen::Vector3d> points);

  std::vector<Eigen::Vector3d> points_;  ///< the last is the first
  std::vector<double> lengths_;          ///< from the start to each point [m]
};

/// A rectangle of |x| <= half_x, |y| <= half_y [m] with round corners, from the middle of its side
/// at y = -half_y on in the sense of a rising yaw.
ClosedPath roundedRectangle(double half_x, double half_y, double radius, double height);

}  // namespace vins::simulation
