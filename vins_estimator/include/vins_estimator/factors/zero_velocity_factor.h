#pragma once

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

namespace vins {

/// A body at rest: velocity over its deviation. Parameter block: motion (9).
class ZeroVelocityFactor : public ceres::SizedCostFunction<3, 9> {
 public:
  /// `sigma` [m/s].
  explicit ZeroVelocityFactor(double sigma) : weight_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    Eigen::Map<Eigen::Vector3d>{residuals} =
        weight_ * Eigen::Map<const Eigen::Vector3d>{parameters[0]};
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, 3, 9, Eigen::RowMajor>> J(jacobians[0]);
    J.setZero();
    J.leftCols<3>().diagonal().setConstant(weight_);
    return true;
  }

 private:
  double weight_;
};

}  // namespace vins
