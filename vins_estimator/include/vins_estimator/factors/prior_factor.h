#pragma once

#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>

#include "vins_estimator/inertial/nav_state.h"

namespace vins {

/// What is known of a group of states in square-root form: residual = A d + b, d being the states'
/// differences from the values `at`, stacked: six numbers for a pose (position, rotation), nine for
/// a motion (velocity, biases).
struct Prior {
  /// One part of the stacked difference.
  struct Part {
    std::size_t frame = 0;  ///< index of the state in the window
    bool motion = false;    ///< velocity and biases, or else the pose
    NavState at;            ///< where the difference is zero
    int size() const { return motion ? 9 : 6; }
  };
  std::vector<Part> parts;
  Eigen::MatrixXd A;  ///< rows x sum of the parts' sizes
  Eigen::VectorXd b;

  bool empty() const { return parts.empty(); }
  int columns() const;
};

/// Difference of a pose (6) or motion (9) part from its zero.
Eigen::VectorXd priorDifference(const Prior::Part& part, const NavState& state);

/// A Prior for Ceres. Parameter blocks: one for each part, pose (7) or motion (9). The Jacobian is
/// A wherever the states go, which keeps the null space. The prior must outlive it.
class PriorFactor : public ceres::CostFunction {
 public:
  explicit PriorFactor(const Prior& prior);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const Prior& prior_;
};

}  // namespace vins
