#include <gtest/gtest.h>

#include "estimator_test_values.h"
#include "vins_core/testing/numeric_jacobian.h"
#include "vins_estimator/factors/bearing_factor.h"
#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/factors/prior_factor.h"
#include "vins_estimator/factors/upright_factor.h"
#include "vins_estimator/factors/zero_motion_factor.h"

namespace vins::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using vins::testing::numericJacobian;

const Vector3d kGravity(0.0, 0.0, -9.81);
const ImuNoise kNoise{2.0e-3, 1.7e-4, 3.0e-3, 1.9e-5, 9.81};

/// A state moved by six numbers of its pose, or by nine of its motion.
NavState movedPose(const NavState& state, const VectorXd& d) {
  Vector15d full = Vector15d::Zero();
  full.head<6>() = d;
  return plus(state, full);
}
NavState movedMotion(const NavState& state, const VectorXd& d) {
  Vector15d full = Vector15d::Zero();
  full.tail<9>() = d;
  return plus(state, full);
}
Pose movedPose(const Pose& pose, const VectorXd& d) {
  NavState state;
  state.T_wb = pose;
  return movedPose(state, d).T_wb;
}

class ImuFactorTest : public ::testing::Test {
 protected:
  ImuFactorTest() : random_(1), i_(random_.navState()), j_(random_.navState()) {
    imu_.integrate(testing::wavingSamples(0.5, 200.0));
    // Rotations that nearly agree, as in use: far apart their logarithm bends.
    j_.T_wb.rotation = i_.T_wb.rotation * imu_.gamma() * so3::exp(Vector3d(0.1, -0.2, 0.15));
  }
  Random random_;
  Preintegration imu_{kNoise, {0.03, -0.05, 0.02}, {0.01, 0.0, -0.01}};
  NavState i_;
  NavState j_;
};

TEST_F(ImuFactorTest, ResidualIsZeroAtThePrediction) {
  EXPECT_LT(imuResidual(imu_, kGravity, i_, imu_.predict(i_, kGravity)).norm(), 1e-12);
}

TEST_F(ImuFactorTest, ResidualDoesNotKnowYawAndPositionOfTheWorld) {
  const Pose turn(so3::exp(Vector3d(0.0, 0.0, 0.7)), Vector3d(3.0, -2.0, 5.0));
  const auto turned = [&](NavState state) {
    state.T_wb = turn * state.T_wb;
    state.v_w = turn.rotation * state.v_w;
    return state;
  };
  EXPECT_LT(
      (imuResidual(imu_, kGravity, i_, j_) - imuResidual(imu_, kGravity, turned(i_), turned(j_)))
          .norm(),
      1e-12);
}

TEST_F(ImuFactorTest, JacobiansAreThoseOfNumericDifferences) {
  const ImuJacobians J = imuJacobians(imu_, kGravity, i_, j_);
  const auto check = [](const MatrixXd& analytic, const MatrixXd& numeric) {
    EXPECT_LT((analytic - numeric).norm(), 1e-9 * numeric.norm());
  };
  check(J.J_pose_i, numericJacobian(
                        [&](const VectorXd& d) -> VectorXd {
                          return imuResidual(imu_, kGravity, movedPose(i_, d), j_);
                        },
                        6));
  check(J.J_pose_j, numericJacobian(
                        [&](const VectorXd& d) -> VectorXd {
                          return imuResidual(imu_, kGravity, i_, movedPose(j_, d));
                        },
                        6));
  check(J.J_motion_i, numericJacobian(
                          [&](const VectorXd& d) -> VectorXd {
                            return imuResidual(imu_, kGravity, movedMotion(i_, d), j_);
                          },
                          9));
  check(J.J_motion_j, numericJacobian(
                          [&](const VectorXd& d) -> VectorXd {
                            return imuResidual(imu_, kGravity, i_, movedMotion(j_, d));
                          },
                          9));
  check(J.J_intrinsics, numericJacobian(
                            [&](const VectorXd& d) -> VectorXd {
                              return imuResidual(imu_, kGravity, i_, j_, imu_.intrinsics() + d);
                            },
                            15));
}

TEST_F(ImuFactorTest, CeresGetsTheWeightedResidualAndJacobians) {
  const WindowState window_i(i_), window_j(j_);
  const ImuFactor factor(imu_, kGravity, window_i, window_j);
  const PoseBlock pose_i = toPoseBlock(i_.T_wb), pose_j = toPoseBlock(j_.T_wb);
  const MotionBlock motion_i = toMotionBlock(i_), motion_j = toMotionBlock(j_);
  const double* parameters[] = {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data()};
  Vector15d residual;
  Eigen::Matrix<double, 15, 7, Eigen::RowMajor> J_pose_i;
  double* jacobians[] = {J_pose_i.data(), nullptr, nullptr, nullptr};
  ASSERT_TRUE(factor.Evaluate(parameters, residual.data(), jacobians));
  const Vector15d plain = imuResidual(imu_, kGravity, i_, j_);
  EXPECT_LT((residual - imu_.sqrtInformation() * plain).norm(), 1e-9 * residual.norm());
  EXPECT_TRUE(J_pose_i.col(6).isZero());
  const Matrix15x6d weighted =
      imu_.sqrtInformation() * imuJacobians(imu_, kGravity, i_, j_).J_pose_i;
  EXPECT_LT((J_pose_i.leftCols<6>() - weighted).norm(), 1e-9 * weighted.norm());
}

/// A landmark seen by two cameras whose extrinsic is not trivial.
class BearingFactorTest : public ::testing::Test {
 protected:
  BearingFactorTest() : random_(2) {
    T_bc_ = random_.pose(0.1);
    T_wh_ = random_.pose();
    const Pose small(so3::exp(0.2 * random_.normal3()), 0.5 * random_.normal3());
    T_wt_ = T_wh_ * small;
    anchor_.bearing = Vector3d(0.2, -0.1, 1.0).normalized();
    anchor_.basis = tangentBasis(anchor_.bearing);
    landmark_ = {0.01, -0.02, 0.3};
    const Vector3d p_w = (T_wh_ * T_bc_) * Vector3d(anchoredDirection(anchor_, landmark_) / 0.3);
    const Vector3d p_t = (T_wt_ * T_bc_).inverse() * p_w;
    measured_.bearing = (p_t.normalized() + 0.02 * random_.normal3()).normalized();
    measured_.basis = tangentBasis(measured_.bearing);
    measured_.inverse_sigma = 460.0;
    exact_bearing_ = p_t.normalized();
  }
  Eigen::Vector2d residual(const Pose& T_bc, const Pose& T_wh, const Pose& T_wt,
                           const Vector3d& landmark, BearingJacobians* J = nullptr) const {
    return bearingResidual(measured_, anchor_, viewGeometry(T_wh, T_bc), viewGeometry(T_wt, T_bc),
                           landmark, J);
  }
  Random random_;
  Pose T_bc_, T_wh_, T_wt_;
  LandmarkAnchor anchor_;
  LandmarkParameters landmark_;
  BearingMeasurement measured_;
  Vector3d exact_bearing_;
};

TEST_F(BearingFactorTest, ResidualIsZeroAtTheTruthAndCountsInDeviations) {
  measured_.bearing = exact_bearing_;
  measured_.basis = tangentBasis(exact_bearing_);
  EXPECT_LT(residual(T_bc_, T_wh_, T_wt_, landmark_).norm(), 1e-10);
  // One pixel (1/460 rad) off is one deviation off.
  const Vector3d axis = measured_.basis.col(0);
  measured_.bearing = so3::exp(axis / 460.0) * exact_bearing_;
  measured_.basis = tangentBasis(measured_.bearing);
  EXPECT_NEAR(residual(T_bc_, T_wh_, T_wt_, landmark_).norm(), 1.0, 1e-5);
}

TEST_F(BearingFactorTest, JacobiansAreThoseOfNumericDifferences) {
  BearingJacobians J;
  residual(T_bc_, T_wh_, T_wt_, landmark_, &J);
  const auto check = [](const MatrixXd& analytic, const MatrixXd& numeric) {
    EXPECT_LT((analytic - numeric).norm(), 1e-8 * numeric.norm());
  };
  check(J.J_host, numericJacobian(
                      [&](const VectorXd& d) -> VectorXd {
                        return residual(T_bc_, movedPose(T_wh_, d), T_wt_, landmark_);
                      },
                      6));
  check(J.J_target, numericJacobian(
                        [&](const VectorXd& d) -> VectorXd {
                          return residual(T_bc_, T_wh_, movedPose(T_wt_, d), landmark_);
                        },
                        6));
  check(J.J_landmark, numericJacobian(
                          [&](const VectorXd& d) -> VectorXd {
                            return residual(T_bc_, T_wh_, T_wt_, landmark_ + Vector3d(d));
                          },
                          3));
  check(extrinsicJacobian(measured_, anchor_, viewGeometry(T_wh_, T_bc_),
                          viewGeometry(T_wt_, T_bc_), landmark_),
        numericJacobian(
            [&](const VectorXd& d) -> VectorXd {
              return residual(movedPose(T_bc_, d), T_wh_, T_wt_, landmark_);
            },
            6));
}

TEST_F(BearingFactorTest, TakesLandmarksAtInfinity) {
  landmark_.z() = 0.0;
  BearingJacobians J;
  EXPECT_TRUE(residual(T_bc_, T_wh_, T_wt_, landmark_, &J).allFinite());
  EXPECT_TRUE(J.J_landmark.allFinite());
  EXPECT_LT(J.J_target.leftCols<3>().norm(), 1e-12);
}

TEST_F(BearingFactorTest, FirstEstimatesHoldTheJacobiansButNotTheResidual) {
  NavState host_state, target_state;
  host_state.T_wb = T_wh_;
  target_state.T_wb = T_wt_;
  WindowState host(host_state), target(target_state);
  const BearingFactor factor(measured_, anchor_, T_bc_, host, target);
  const auto evaluate = [&](const Pose& T_wh, Eigen::Vector2d* residual) {
    const PoseBlock block_h = toPoseBlock(T_wh), block_t = toPoseBlock(T_wt_);
    const double* parameters[] = {block_h.data(), block_t.data(), landmark_.data()};
    Eigen::Matrix<double, 2, 7, Eigen::RowMajor> J;
    double* jacobians[] = {J.data(), nullptr, nullptr};
    EXPECT_TRUE(factor.Evaluate(parameters, residual->data(), jacobians));
    return J;
  };
  Eigen::Vector2d before, moved, fixed;
  const Pose elsewhere = movedPose(T_wh_, 0.1 * VectorXd::Ones(6));
  const auto J_before = evaluate(T_wh_, &before);
  const auto J_moved = evaluate(elsewhere, &moved);
  host.fixPose();
  const auto J_fixed = evaluate(elsewhere, &fixed);
  EXPECT_GT((J_moved - J_before).norm(), 1e-2 * J_before.norm());
  EXPECT_EQ(J_fixed, J_before);
  EXPECT_EQ(fixed, moved);
}

TEST_F(BearingFactorTest, HostJacobianIsThatOfNumericDifferences) {
  const HostBearingFactor factor(measured_, anchor_);
  const auto f = [&](const VectorXd& d) -> VectorXd {
    const Vector3d landmark = landmark_ + Vector3d(d);
    const double* parameters[] = {landmark.data()};
    Eigen::Vector2d r;
    factor.Evaluate(parameters, r.data(), nullptr);
    return r;
  };
  const double* parameters[] = {landmark_.data()};
  Eigen::Vector2d r;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> J;
  double* jacobians[] = {J.data()};
  factor.Evaluate(parameters, r.data(), jacobians);
  EXPECT_LT((J - numericJacobian(f, 3)).norm(), 1e-8 * J.norm());
}

TEST(ZeroMotion, JacobiansAreThoseOfNumericDifferences) {
  Random random(11);
  const NavState i = random.navState();
  NavState j = i;
  j.T_wb = i.T_wb * Pose(so3::exp(Vector3d(0.1, -0.05, 0.2)), Vector3d(0.02, 0.1, -0.03));
  const ZeroMotionNoise noise{0.01, 0.5, 0.2};
  Eigen::Matrix<double, 6, 6> J_i, J_j;
  zeroMotionResidual(noise, i.T_wb, j.T_wb, &J_i, &J_j);
  const auto residual = [&](const NavState& a, const NavState& b) -> VectorXd {
    return zeroMotionResidual(noise, a.T_wb, b.T_wb, nullptr, nullptr);
  };
  const MatrixXd numeric_i =
      numericJacobian([&](const VectorXd& d) { return residual(movedPose(i, d), j); }, 6);
  const MatrixXd numeric_j =
      numericJacobian([&](const VectorXd& d) { return residual(i, movedPose(j, d)); }, 6);
  EXPECT_LT((J_i - numeric_i).norm(), 1e-9 * numeric_i.norm());
  EXPECT_LT((J_j - numeric_j).norm(), 1e-9 * numeric_j.norm());
}

TEST(ZeroMotion, DoesNotKnowPlaceAndHeading) {
  Random random(12);
  const Pose T_wi = random.pose(), T_wj = random.pose();
  const Pose turn(so3::exp(Vector3d(0.0, 0.0, 0.7)), Vector3d(3.0, -2.0, 5.0));
  EXPECT_LT((zeroMotionResidual({}, turn * T_wi, turn * T_wj, nullptr, nullptr) -
             zeroMotionResidual({}, T_wi, T_wj, nullptr, nullptr))
                .norm(),
            1e-9);
  EXPECT_LT(zeroMotionResidual({}, T_wi, T_wi, nullptr, nullptr).norm(), 1e-9);
}

TEST(Upright, JacobianIsThatOfNumericDifferences) {
  Random random(13);
  const NavState state = random.navState();
  const Vector3d up_b = (state.T_wb.rotation.conjugate() * Vector3d(0.1, 0.05, 1.0)).normalized();
  Eigen::Matrix<double, 2, 3> J;
  uprightResidual(up_b, 20.0, state.T_wb.rotation, &J);
  const MatrixXd numeric = numericJacobian(
      [&](const VectorXd& d) -> VectorXd {
        return uprightResidual(up_b, 20.0, movedPose(state, d).T_wb.rotation, nullptr);
      },
      6);
  EXPECT_LT((J - numeric.rightCols<3>()).norm(), 1e-8 * numeric.norm());
}

TEST(PriorFactor, IsLinearInTheDifferences) {
  Random random(3);
  Prior prior;
  const NavState at = random.navState();
  prior.parts = {{Prior::Kind::kPose, 0, at, {}, {}}, {Prior::Kind::kMotion, 0, at, {}, {}}};
  prior.A = MatrixXd::Random(7, 15);
  prior.b = VectorXd::Random(7);
  const PriorFactor factor(prior);
  Vector15d d;
  for (double& x : d) x = 0.3 * random.normal();
  const NavState moved = plus(at, d);
  const PoseBlock pose = toPoseBlock(moved.T_wb);
  const MotionBlock motion = toMotionBlock(moved);
  const double* parameters[] = {pose.data(), motion.data()};
  VectorXd residual(7);
  Eigen::Matrix<double, 7, 7, Eigen::RowMajor> J_pose;
  Eigen::Matrix<double, 7, 9, Eigen::RowMajor> J_motion;
  double* jacobians[] = {J_pose.data(), J_motion.data()};
  ASSERT_TRUE(factor.Evaluate(parameters, residual.data(), jacobians));
  EXPECT_LT((residual - (prior.A * d + prior.b)).norm(), 1e-12);
  EXPECT_EQ(J_pose.leftCols(6), prior.A.leftCols(6));
  EXPECT_EQ(J_motion, prior.A.rightCols(9));
}

TEST(PoseManifold, MinusUndoesPlus) {
  Random random(4);
  const PoseManifold manifold;
  const PoseBlock x = toPoseBlock(random.pose());
  const Eigen::Matrix<double, 6, 1> d = 0.4 * Eigen::Matrix<double, 6, 1>::Random();
  PoseBlock y;
  manifold.Plus(x.data(), d.data(), y.data());
  Eigen::Matrix<double, 6, 1> back;
  manifold.Minus(y.data(), x.data(), back.data());
  EXPECT_LT((back - d).norm(), 1e-13);
}

}  // namespace
}  // namespace vins::estimator
