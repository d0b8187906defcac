#pragma once

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins::estimator {

using Vector15d = Eigen::Matrix<double, 15, 1>;
using Matrix15d = Eigen::Matrix<double, 15, 15>;

/// Where the error states stand in a 15-vector, everywhere.
enum ErrorState { kPosition = 0, kRotation = 3, kVelocity = 6, kAccBias = 9, kGyrBias = 12 };

/// State of the body at one time.
struct NavState {
  Pose T_wb;                                                     ///< body in the world
  Eigen::Vector3d v_w = Eigen::Vector3d::Zero();                 ///< velocity [m/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2], body frame
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();      ///< [rad/s], body frame
};

/// A state and its time [ns], in the camera's clock.
struct StampedNavState {
  Stamp stamp = 0;
  NavState state;
};

/// state [+] d: vectors are added, the rotation is perturbed on the right.
NavState plus(const NavState& state, const Vector15d& d);

/// d with plus(from, d) = to.
Vector15d minus(const NavState& to, const NavState& from);

/// All components are finite.
bool isFinite(const NavState& state);

/// A state of the window. Once the prior has touched its pose or its motion (velocity and biases),
/// that part is linearized where it then stood: first-estimates Jacobians (G. Huang, A. Mourikis,
/// S. Roumeliotis, "Observability-based rules for designing consistent EKF SLAM estimators",
/// IJRR 2010). The current value goes on changing.
class WindowState {
 public:
  WindowState() = default;
  explicit WindowState(const NavState& value) : value_(value), first_estimate_(value) {}

  const NavState& value() const { return value_; }
  void setValue(const NavState& value) { value_ = value; }

  bool isPoseFixed() const { return pose_fixed_; }
  bool isMotionFixed() const { return motion_fixed_; }

  /// Keeps the present value as first estimate; does nothing where there is one already.
  void fixPose();
  void fixMotion();

  /// From now on Jacobians are taken at present values, as VINS-Mono does: to study what that does.
  void ignoreFirstEstimates() { ignore_first_estimates_ = true; }
  /// Jacobians by the pose are taken elsewhere than at its present value.
  bool hasPoseForJacobians() const { return pose_fixed_ && !ignore_first_estimates_; }

  /// Where Jacobians by the pose are taken: the first estimate, or else `current`.
  const Pose& poseForJacobians(const Pose& current) const {
    return hasPoseForJacobians() ? first_estimate_.T_wb : current;
  }
  /// Where Jacobians by velocity and biases are taken (the pose in it is of no meaning).
  const NavState& motionForJacobians(const NavState& current) const {
    return motion_fixed_ && !ignore_first_estimates_ ? first_estimate_ : current;
  }
  /// Where the whole state is linearized.
  NavState linearizationPoint(const NavState& current) const {
    NavState at = motionForJacobians(current);
    at.T_wb = poseForJacobians(current.T_wb);
    return at;
  }
  /// What the prior's differences are taken from.
  const NavState& firstEstimate() const { return first_estimate_; }

 private:
  NavState value_;
  NavState first_estimate_;
  bool pose_fixed_ = false;
  bool motion_fixed_ = false;
  bool ignore_first_estimates_ = false;
};

}  // namespace vins::estimator
