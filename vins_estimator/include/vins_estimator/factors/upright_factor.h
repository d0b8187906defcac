#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vins::estimator {

/// Weighted residual of a body of which roll and pitch are known, while it may turn about the
/// vertical and stand anywhere: the vertical, seen in the body frame, against the one known there
/// (`up_b`, unit), on the tangent plane of the unit sphere. `inverse_sigma`: [1/rad]. `J_rotation`,
/// where not null: derivative by the rotation's error (on the right).
Eigen::Vector2d uprightResidual(const Eigen::Vector3d& up_b, double inverse_sigma,
                                const Eigen::Quaterniond& R_wb,
                                Eigen::Matrix<double, 2, 3>* J_rotation);

}  // namespace vins::estimator
