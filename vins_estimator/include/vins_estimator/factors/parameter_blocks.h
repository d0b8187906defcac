#pragma once

#include <array>

#include <ceres/manifold.h>

#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// A pose as Ceres holds it: position x y z, quaternion x y z w.
using PoseBlock = std::array<double, 7>;
/// Velocity, accelerometer bias, gyroscope bias.
using MotionBlock = std::array<double, 9>;

PoseBlock toPoseBlock(const Pose& pose);
Pose toPose(const double* block);
MotionBlock toMotionBlock(const NavState& state);
/// Takes velocity and biases from the block.
void setMotion(const double* block, NavState* state);
NavState toNavState(const double* pose_block, const double* motion_block);

/// Poses perturbed by (position, rotation on the right). A factor writes its derivatives by these
/// six into the first six of the seven columns that Ceres hands it, and zeros into the last: the
/// manifold's own Jacobian is the identity on them. (The usual way to give Ceres Jacobians of the
/// tangent space, which spares the detour by derivatives of quaternions.)
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

}  // namespace vins::estimator
