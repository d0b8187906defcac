#include "vins_core/tangent_basis.h"

#include <Eigen/Geometry>

namespace vins {

Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& unit) {
  // The axis that is most nearly orthogonal to the vector.
  int axis = 0;
  unit.cwiseAbs().minCoeff(&axis);
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = unit.cross(Eigen::Vector3d::Unit(axis)).normalized();
  basis.col(1) = unit.cross(basis.col(0));
  return basis;
}

}  // namespace vins
