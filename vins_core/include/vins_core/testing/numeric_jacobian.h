#pragma once

#include <functional>

#include <Eigen/Core>

namespace vins::testing {

/// Jacobian of f at zero by five-point central differences, whose error falls with the fourth
/// power of `step`. `f` maps a perturbation of `size` numbers to a vector; for states on a manifold
/// the caller applies the perturbation ([+]) inside and takes the difference ([-]) where the value
/// is no vector. The one helper by which every analytic Jacobian is tested.
inline Eigen::MatrixXd numericJacobian(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, int size, double step = 1e-3) {
  Eigen::MatrixXd J;
  for (int i = 0; i < size; ++i) {
    const Eigen::VectorXd d = step * Eigen::VectorXd::Unit(size, i);
    const Eigen::VectorXd column =
        (8.0 * (f(d) - f(-d)) - (f(2.0 * d) - f(-2.0 * d))) / (12.0 * step);
    if (i == 0) J.resize(column.size(), size);
    J.col(i) = column;
  }
  return J;
}

}  // namespace vins::testing
