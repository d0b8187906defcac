#pragma once

#include <Eigen/Core>

namespace vins {

/// Two orthonormal columns that span the tangent plane of the unit sphere at `unit`, a vector of
/// length 1; with it as third column they are a rotation. The same vector always gives the same
/// basis, but the bases of neighbouring vectors may differ by a turn about them.
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& unit);

}  // namespace vins
