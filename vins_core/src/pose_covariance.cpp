#include "vins_core/pose_covariance.h"

#include "vins_core/so3.h"

namespace vins {
namespace {

using se3::Matrix6d;

Matrix6d transformed(const Matrix6d& J, const Matrix6d& covariance) {
  return J * covariance * J.transpose();
}

/// J with (dp, dphi) of a point at p + arm = J (dp, dphi) of a point at p, on one rigid body.
Matrix6d leverArm(const Eigen::Vector3d& arm) {
  Matrix6d J = Matrix6d::Identity();
  J.topRightCorner<3, 3>() = -so3::hat(arm);
  return J;
}

/// Turns only the rotation's error.
Matrix6d turnedRotation(const Eigen::Quaterniond& R) {
  Matrix6d J = Matrix6d::Identity();
  J.bottomRightCorner<3, 3>() = R.toRotationMatrix();
  return J;
}

}  // namespace

Matrix6d aboutFixedAxes(const Eigen::Quaterniond& R_ab, const Matrix6d& covariance) {
  return transformed(turnedRotation(R_ab), covariance);
}

Matrix6d aboutBodyAxes(const Eigen::Quaterniond& R_ab, const Matrix6d& covariance) {
  return transformed(turnedRotation(R_ab.conjugate()), covariance);
}

Matrix6d covarianceOfProduct(const Pose& T_ab, const Matrix6d& covariance_ab, const Pose& T_bc,
                             const Matrix6d& covariance_bc) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T_ab.rotation.toRotationMatrix();
  return transformed(leverArm(T_ab.rotation * T_bc.position), covariance_ab) +
         transformed(turn, covariance_bc);
}

Matrix6d covarianceByPoint(const Eigen::Vector3d& arm_a, const Matrix6d& covariance) {
  return transformed(leverArm(-arm_a), covariance);
}

}  // namespace vins
