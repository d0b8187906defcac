#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "synthetic_window.h"
#include "vins_estimator/window/marginalization.h"
#include "vins_estimator/window/outlier_gate.h"
#include "vins_estimator/window/window_solver.h"
#include "vins_estimator/window/window_system.h"

namespace vins::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using testing::makeWindow;
using testing::SyntheticWindow;
using testing::Visibility;

constexpr double kHuber = 1e9;  // no measurement is an outlier here

Visibility always(int /*landmark*/) { return {}; }
/// Half of the landmarks are lost before the newest frame comes.
Visibility halfLost(int landmark) {
  return landmark % 2 == 0 ? Visibility{0, 5} : Visibility{1, 1000};
}

void perturb(SlidingWindow* window, double size, std::uint64_t seed) {
  testing::Random random(seed);
  for (WindowFrame& frame : window->frames) {
    Vector15d d;
    for (double& x : d) x = size * random.normal();
    frame.state.setValue(plus(frame.state.value(), d));
  }
}

/// Directions in which the whole window may move unseen: three shifts, and a turn about gravity,
/// at the points where the states are linearized.
MatrixXd nullSpace(const SlidingWindow& window) {
  MatrixXd N = MatrixXd::Zero(static_cast<Index>(15 * window.frames.size()), 4);
  for (std::size_t i = 0; i < window.frames.size(); ++i) {
    const WindowState& state = window.frames[i].state;
    const Pose at = state.poseForJacobians(state.value().T_wb);
    const Vector3d v = state.motionForJacobians(state.value()).v_w;
    const auto row = static_cast<Index>(15 * i);
    N.block<3, 3>(row + kPosition, 0).setIdentity();
    N.block<3, 1>(row + kPosition, 3) = Vector3d::UnitZ().cross(at.position);
    N.block<3, 1>(row + kRotation, 3) = at.rotation.conjugate() * Vector3d::UnitZ();
    N.block<3, 1>(row + kVelocity, 3) = Vector3d::UnitZ().cross(v);
  }
  return N;
}

MatrixXd windowInformation(const SlidingWindow& window) {
  WindowSystem system(window, kHuber);
  system.linearize(system.present());  // without a prior the information is singular, but there
  return system.information();
}

Matrix15d newestCovariance(const SlidingWindow& window) {
  WindowSystem system(window, kHuber);
  EXPECT_TRUE(system.linearize(system.present()));
  return system.newestCovariance();
}

/// Largest information along the null space, against the least of the shifts' usual scale.
double informationOnNullSpace(const SlidingWindow& window) {
  const MatrixXd H = windowInformation(window);
  const MatrixXd N = nullSpace(window);
  return (N.transpose() * H * N).cwiseAbs().maxCoeff();
}

TEST(WindowSolver, FindsTheTruthFromAPerturbedStart) {
  SyntheticWindow synthetic = makeWindow(8, 80, 0.0, always);
  perturb(&synthetic.window, 0.02, 1);
  triangulateTracks(&synthetic.window);
  WindowSolverOptions options;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-12;
  options.huber = kHuber;
  ASSERT_TRUE(solveWindow(options, &synthetic.window).usable);
  // The second solution integrates with the biases that the first has found.
  const SolveSummary summary = solveWindow(options, &synthetic.window);
  ASSERT_TRUE(summary.usable);
  EXPECT_EQ(summary.landmarks, 80);
  for (std::size_t i = 0; i < synthetic.truth.size(); ++i) {
    EXPECT_LT(minus(synthetic.window.frames[i].state.value(), synthetic.truth[i]).head<9>().norm(),
              1e-6)
        << i;
  }
}

TEST(WindowSolver, IsDeterministic) {
  SyntheticWindow a = makeWindow(8, 80, 1.0, always);
  SyntheticWindow b = makeWindow(8, 80, 1.0, always);
  solveWindow({}, &a.window);
  solveWindow({}, &b.window);
  EXPECT_EQ(minus(a.window.frames.back().state.value(), b.window.frames.back().state.value()),
            Vector15d::Zero());
}

TEST(WindowSystem, NewestCovarianceIsTheBlockOfTheInverse) {
  const SyntheticWindow synthetic = makeWindow(6, 60, 1.0, always);
  const MatrixXd H = windowInformation(synthetic.window);
  const MatrixXd inverse = H.ldlt().solve(MatrixXd::Identity(H.rows(), H.cols()));
  const Matrix15d covariance = newestCovariance(synthetic.window);
  const Matrix15d expected = inverse.bottomRightCorner<15, 15>();
  EXPECT_LT((covariance - expected).norm(), 1e-6 * expected.norm());
}

TEST(WindowSystem, InformationIsBlindToPositionAndYaw) {
  SyntheticWindow synthetic = makeWindow(6, 60, 1.0, always);
  EXPECT_GT(informationOnNullSpace(synthetic.window), 1e5);  // the prior on the first state
  synthetic.window.prior = Prior{};
  EXPECT_LT(informationOnNullSpace(synthetic.window), 1e-4);
}

TEST(Marginalization, LosesNothingWhenAllOfTheOldestFramesLandmarksGo) {
  SyntheticWindow synthetic = makeWindow(7, 60, 1.0, halfLost);
  SlidingWindow& window = synthetic.window;
  const Matrix15d before = newestCovariance(window);
  marginalizeOldest(kHuber, &window);
  const Matrix15d after = newestCovariance(window);
  // The information along a landmark's depth is regularized by 1e-6 in the one and not the other.
  EXPECT_LT((after - before).norm(), 1e-5 * before.norm());
}

TEST(Marginalization, KeepsTheOptimum) {
  WindowSolverOptions options;
  options.max_num_iterations = 30;
  options.huber = kHuber;
  SyntheticWindow synthetic = makeWindow(7, 60, 1.0, halfLost);
  SlidingWindow& window = synthetic.window;
  solveWindow(options, &window);
  const NavState before = window.frames.back().state.value();
  marginalizeOldest(kHuber, &window);
  solveWindow(options, &window);
  // A solution stops when its cost changes by less than 1e-4 of itself.
  const Vector15d sigma = newestCovariance(window).diagonal().cwiseSqrt();
  const Vector15d moved = minus(window.frames.back().state.value(), before);
  EXPECT_LT(moved.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.1);
}

TEST(Marginalization, LandmarksStillTrackedMoveToTheirNextFrame) {
  SyntheticWindow synthetic = makeWindow(5, 40, 0.0, always);
  SlidingWindow& window = synthetic.window;
  const CameraPoses cameras = window.cameras();
  const Landmark& landmark = window.landmarks.tracks().at(3);
  const Vector3d before = positionInWorld(landmark, cameras.at(landmark.host()));
  marginalizeOldest(kHuber, &window);
  ASSERT_EQ(window.landmarks.tracks().size(), 40U);
  EXPECT_EQ(landmark.host(), 1);
  EXPECT_EQ(landmark.observations.size(), 4U);
  EXPECT_LT((positionInWorld(landmark, cameras.at(1)) - before).norm(), 1e-9);
}

/// Frames go one after the other while the estimates go on changing, without any first prior.
SyntheticWindow slidWindow(bool first_estimates) {
  SyntheticWindow synthetic = makeWindow(9, 60, 1.0, halfLost);
  SlidingWindow& window = synthetic.window;
  window.prior = Prior{};
  for (WindowFrame& frame : window.frames) {
    frame.state = WindowState(frame.state.value());
    if (!first_estimates) frame.state.ignoreFirstEstimates();
  }
  for (int i = 0; i < 3; ++i) {
    marginalizeOldest(kHuber, &window);
    perturb(&window, 0.01, 10 + static_cast<std::uint64_t>(i));
  }
  return synthetic;
}

TEST(Marginalization, FirstEstimatesKeepTheNullSpaceOfFourDimensions) {
  const SyntheticWindow with = slidWindow(true);
  const SyntheticWindow without = slidWindow(false);
  // Rounding: 1e-16 times the greatest information, of about 1e10.
  EXPECT_LT(informationOnNullSpace(with.window), 1e-3);
  EXPECT_GT(informationOnNullSpace(without.window), 1.0);
}

TEST(Marginalization, PriorHasNoMoreRowsThanColumns) {
  SyntheticWindow synthetic = makeWindow(8, 60, 1.0, halfLost);
  for (int i = 0; i < 3; ++i) marginalizeOldest(kHuber, &synthetic.window);
  const Prior& prior = synthetic.window.prior;
  EXPECT_LE(prior.A.rows(), prior.A.cols());
  EXPECT_EQ(prior.A.cols(), prior.columns());
  EXPECT_TRUE(prior.A.allFinite());
}

TEST(DropFrame, JoinsTheImuIntervals) {
  SyntheticWindow synthetic = makeWindow(6, 40, 0.0, always);
  SlidingWindow& window = synthetic.window;
  dropFrame(&window, 4);
  ASSERT_EQ(window.frames.size(), 5U);
  EXPECT_NEAR(window.frames.back().imu.duration(), 0.4, 1e-12);
  const NavState predicted =
      window.frames.back().imu.predict(window.frames[3].state.value(), window.g_w);
  EXPECT_LT(minus(predicted, synthetic.truth.back()).norm(), 1e-9);
  for (const auto& [id, track] : window.landmarks.tracks()) EXPECT_FALSE(track.isSeenIn(4));
}

TEST(OutlierGate, TakesTheWrongObservationOnly) {
  SyntheticWindow synthetic = makeWindow(6, 40, 0.0, always);
  SlidingWindow& window = synthetic.window;
  TrackObservation& wrong = window.landmarks.tracks().at(5).observations[3];
  wrong.measured.bearing =
      so3::exp(wrong.measured.basis.col(0) * 10.0 / 460.0) * wrong.measured.bearing;
  wrong.measured.basis = tangentBasis(wrong.measured.bearing);
  EXPECT_EQ(removeOutliers({}, &window), 1);
  EXPECT_FALSE(window.landmarks.tracks().at(5).isSeenIn(3));
  EXPECT_EQ(window.landmarks.tracks().at(5).observations.size(), 5U);
}

}  // namespace
}  // namespace vins::estimator
