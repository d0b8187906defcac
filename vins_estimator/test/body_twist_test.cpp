#include "vins_estimator/inertial/body_twist.h"

#include <gtest/gtest.h>

#include "vins_core/so3.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

NavState someState() {
  NavState state;
  state.T_wb = {so3::exp({0.3, -1.4, 0.8}), {1.0, 2.0, 3.0}};
  state.v_w = {1.5, -0.5, 0.2};
  state.gyroscope_bias = {0.01, -0.02, 0.03};
  return state;
}

TEST(BodyTwist, ItsCovarianceIsThatOfTheStateAndOfTheReading) {
  const Vector3d reading(0.3, 0.2, -0.5);
  const NavState state = someState();
  const auto twistOf = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
    const NavState moved = plus(state, d);
    Eigen::VectorXd twist(6);
    twist << moved.T_wb.rotation.conjugate() * moved.v_w, reading - moved.gyroscope_bias;
    return twist;
  };
  const Eigen::MatrixXd J = vins::testing::numericJacobian(twistOf, 15);
  Matrix15d covariance;
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 15; ++j) covariance(i, j) = (i == j ? 1.0 + 0.1 * i : 0.01 * (i + j));
  }
  Eigen::MatrixXd expected = J * covariance * J.transpose();
  expected.diagonal().tail<3>().array() += 0.25;
  const BodyTwist twist = bodyTwist(state, covariance, reading - state.gyroscope_bias, 0.25);
  // Central differences.
  EXPECT_LT((twist.covariance - expected).norm(), 1e-6 * expected.norm());
  EXPECT_LT((twist.linear_b - twistOf(Vector15d::Zero()).head<3>()).norm(), 1e-12);
  EXPECT_LT((twist.angular_b - twistOf(Vector15d::Zero()).tail<3>()).norm(), 1e-12);
}

TEST(BodyTwist, AnUnknownYawLeavesTheVelocityInTheBodyKnown) {
  // An error of the yaw turns pose and velocity alike.
  const NavState state = someState();
  const Vector3d up_b = state.T_wb.rotation.conjugate() * Vector3d::UnitZ();
  Vector15d yaw = Vector15d::Zero();
  yaw.segment<3>(kRotation) = up_b;
  yaw.segment<3>(kVelocity) = Vector3d::UnitZ().cross(state.v_w);
  const BodyTwist twist = bodyTwist(state, yaw * yaw.transpose(), Vector3d::Zero(), 0.0);
  EXPECT_LT((twist.covariance.topLeftCorner<3, 3>().norm()), 1e-12);
}

}  // namespace
}  // namespace vins::estimator
