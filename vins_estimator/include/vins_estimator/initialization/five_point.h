#pragma once

#include <vector>

#include <Eigen/Core>

namespace vins::estimator {

/// The essential matrices, at most ten, of five pairs of bearings: b2^T E b1 = 0 (unit vectors, any
/// camera). Empty where the pairs are degenerate. E lies in the four-dimensional null space of the
/// five equations; det E = 0 and 2 E E^T E = tr(E E^T) E are ten cubic equations in three unknowns,
/// solved by the eigenvectors of the matrix that multiplies by one unknown (D. Nister, "An
/// efficient solution to the five-point relative pose problem", TPAMI 2004; H. Stewenius, C.
/// Engels, D. Nister, "Recent developments on direct relative orientation", ISPRS 2006).
std::vector<Eigen::Matrix3d> essentialMatrices(const Eigen::Matrix<double, 3, 5>& bearings_1,
                                               const Eigen::Matrix<double, 3, 5>& bearings_2);

}  // namespace vins::estimator
