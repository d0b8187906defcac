#pragma once

#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>

#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/rig_calibration.h"

namespace vins::estimator {

/// What is known of a group of states in square-root form: residual = A d + b, d being the states'
/// differences from the values `at`, stacked: six numbers for a pose (position, rotation), nine for
/// a motion (velocity, biases), those of its variables for the rig.
struct Prior {
  enum class Kind { kPose, kMotion, kRig };
  /// One part of the stacked difference.
  struct Part {
    Kind kind = Kind::kPose;
    std::size_t frame = 0;  ///< index of the state in the window; 0 for the rig
    NavState at;            ///< where the difference of a pose or motion is zero
    RigCalibration rig_at;  ///< the same for the rig
    RigVariables rig_variables;
    int size() const;
  };
  std::vector<Part> parts;
  Eigen::MatrixXd A;  ///< rows x sum of the parts' sizes
  Eigen::VectorXd b;

  bool empty() const { return parts.empty(); }
  int columns() const;
};

/// Difference of a part from its zero; `state` is the one of its frame.
Eigen::VectorXd priorDifference(const Prior::Part& part, const NavState& state,
                                const RigCalibration& rig);

/// A Prior on states (without a rig) for Ceres. Parameter blocks: one for each part, pose (7) or
/// motion (9). The Jacobian is
/// A wherever the states go, which keeps the null space. The prior must outlive it.
class PriorFactor : public ceres::CostFunction {
 public:
  explicit PriorFactor(const Prior& prior);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const Prior& prior_;
};

}  // namespace vins::estimator
