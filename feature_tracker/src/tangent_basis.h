#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vins {

/// Two orthonormal vectors, as columns, that are orthogonal to a unit vector.
inline Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& unit) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = unit.unitOrthogonal();
  basis.col(1) = unit.cross(basis.col(0));
  return basis;
}

}  // namespace vins
