#include "vins_estimator/factors/upright_factor.h"

#include "vins_core/so3.h"
#include "vins_estimator/factors/bearing_factor.h"

namespace vins::estimator {

Eigen::Vector2d uprightResidual(const Eigen::Vector3d& up_b, double inverse_sigma,
                                const Eigen::Quaterniond& R_wb,
                                Eigen::Matrix<double, 2, 3>* J_rotation) {
  const Eigen::Matrix<double, 2, 3> weighted = inverse_sigma * tangentBasis(up_b).transpose();
  const Eigen::Vector3d up = R_wb.conjugate() * Eigen::Vector3d::UnitZ();
  if (J_rotation != nullptr) *J_rotation = weighted * so3::hat(up);
  return weighted * up;
}

}  // namespace vins::estimator
