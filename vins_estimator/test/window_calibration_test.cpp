#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "synthetic_window.h"
#include "vins_core/testing/numeric_jacobian.h"
#include "vins_estimator/window/linearization.h"
#include "vins_estimator/window/loop_closing.h"
#include "vins_estimator/window/marginalization.h"
#include "vins_estimator/window/motion_only.h"
#include "vins_estimator/window/window_solver.h"
#include "vins_estimator/window/window_system.h"

namespace vins::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::makeWindow;
using testing::SyntheticWindow;
using testing::Visibility;
using vins::testing::numericJacobian;

constexpr double kHuber = 1e9;  // no measurement is an outlier here

Visibility always(int /*landmark*/) { return {}; }
Visibility upToTheSixth(int landmark) {
  return landmark < 40 ? Visibility{0, 6} : Visibility{1, 99};
}

/// The rig's variables become unknowns, known to the deviations `sigma` of all its errors.
void refineRig(const RigVariables& variables, const RigVector& sigma, SlidingWindow* window) {
  window->refines_rig = true;
  window->rig_variables = variables;
  const auto rows = window->prior.A.rows(), columns = window->prior.A.cols();
  const Eigen::Index size = variables.size();
  window->prior.parts.push_back({Prior::Kind::kRig, 0, {}, window->rig, variables});
  window->prior.A.conservativeResizeLike(MatrixXd::Zero(rows + size, columns + size));
  window->prior.A.bottomRightCorner(size, size).diagonal() =
      selected(variables, sigma).cwiseInverse();
  window->prior.b.conservativeResizeLike(VectorXd::Zero(rows + size));
}

/// Extrinsic and td become unknowns, known to these deviations.
void refineRig(double position, double rotation, double td, SlidingWindow* window) {
  RigVector sigma = RigVector::Zero();
  sigma.head<7>() << Vector3d::Constant(position), Vector3d::Constant(rotation), td;
  refineRig({}, sigma, window);
}

WindowSolverOptions thorough() {
  WindowSolverOptions options;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-14;
  options.huber = kHuber;
  return options;
}

/// Derivatives of observations by the rig's errors, analytic and numeric, one after the other.
void checkRigJacobians(double readout, const CameraIntrinsics& intrinsics, double tolerance) {
  SyntheticWindow synthetic = makeWindow(6, 20, 1.0, always);
  SlidingWindow& window = synthetic.window;
  window.refines_rig = true;
  window.rig_variables.camera = true;
  window.rig.readout = readout;
  window.rig.intrinsics = intrinsics;
  window.rig.td = 0.012;  // the frames were timed with zero: they are carried
  WindowValues values = window.values();
  const WindowGeometry geometry = geometryOf(window, values);
  for (auto& [id, landmark] : window.landmarks.tracks()) {
    ASSERT_TRUE(landmark.has_depth);
    landmark.anchor.row = 0.3;
    const std::size_t target = 1 + static_cast<std::size_t>(id) % 5;
    BearingMeasurement& measured = landmark.observations[target].measured;
    measured.row = 0.05 * static_cast<double>(id);
    const LinearizedObservation o =
        linearizeObservation(measured, landmark.anchor, geometry, 0, target, landmark.parameters);
    const MatrixXd numeric = numericJacobian(
        [&](const VectorXd& d) -> VectorXd {
          WindowValues moved = values;
          moved.rig = plus(values.rig, expanded(window.rig_variables, RigStep(d)));
          return observationResidual(measured, landmark.anchor, geometryOf(window, moved), 0,
                                     target, landmark.parameters);
        },
        kCameraRigSize);
    for (int i = 0; i < kCameraRigSize; ++i) {
      EXPECT_LT((o.J_rig.col(i) - numeric.col(i)).norm(), tolerance * numeric.col(i).norm() + 1e-6)
          << "landmark " << id << ", error " << i;
    }
  }
}

TEST(RigJacobian, IsThatOfNumericDifferences) {
  checkRigJacobians(0.0, CameraIntrinsics::Zero(), 1e-6);
}

// How the camera's own motion and where it sees a landmark depend on the other errors is left out:
// some hundredths, over 3 ms and with focal lengths that are off by a percent.
TEST(RigJacobian, HoldsNearlyWhereErrorsAreLarge) {
  CameraIntrinsics intrinsics;
  intrinsics << 0.01, -0.008, 0.004, -0.006, 0.03, -0.02;
  checkRigJacobians(0.003, intrinsics, 0.06);
}

TEST(RigCalibrationInWindow, IsFoundFromAWrongStart) {
  SyntheticWindow synthetic = makeWindow(10, 80, 0.0, always);
  SlidingWindow& window = synthetic.window;
  const RigCalibration truth = window.rig;
  RigVector error = RigVector::Zero();
  error.head<7>() << 0.02, -0.03, 0.01, 0.03, 0.05, -0.04, 0.01;
  window.rig = plus(truth, error);
  refineRig(0.1, 0.1, 0.03, &window);
  const SolveSummary summary = solveWindow(thorough(), &window);
  ASSERT_TRUE(summary.usable);
  // Held near its start by nothing but a loose prior, next to measurements without noise: what is
  // left of the error lies far within the deviations that the solution itself states.
  const RigVector left = minus(window.rig, truth);
  const RigVector sigma = summary.rig_covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < 7; ++i) EXPECT_LT(std::abs(left(i)), 0.5 * sigma(i)) << i;
  EXPECT_LT(left.segment<3>(3).norm(), 0.1 * error.segment<3>(3).norm());
  EXPECT_LT(std::abs(left(6)), 0.1 * error(6));
}

/// Moves one of the rig's errors off its true value and solves: what is left of it, over its
/// deviation before and after.
void checkIsFound(int error, double size, double sigma) {
  SyntheticWindow synthetic = makeWindow(10, 80, 0.0, always);
  SlidingWindow& window = synthetic.window;
  for (auto& [id, landmark] : window.landmarks.tracks()) {
    for (TrackObservation& o : landmark.observations) {
      o.measured.row = 0.01 * static_cast<double>((31 * id + 17 * o.frame) % 100);
    }
    landmark.anchor.row = landmark.observations.front().measured.row;
  }
  const RigCalibration truth = window.rig;
  window.rig = plus(truth, size * RigVector::Unit(error));
  RigVector deviations = RigVector::Constant(1e-9);
  deviations(error) = sigma;
  RigVariables all;
  all.camera = true;
  all.imu = true;
  refineRig(all, deviations, &window);
  const SolveSummary summary = solveWindow(thorough(), &window);
  ASSERT_TRUE(summary.usable) << error;
  const double left = minus(window.rig, truth)(error);
  const double known = std::sqrt(summary.rig_covariance(error, error));
  EXPECT_LT(known, 0.7 * sigma) << error;
  EXPECT_LT(std::abs(left), 0.7 * known) << error;
}

TEST(RigCalibrationInWindow, FindsEachErrorOfTheCamera) {
  checkIsFound(kReadout, 0.006, 0.01);
  for (int i = 0; i < 4; ++i) checkIsFound(kIntrinsics + i, 0.006, 0.01);
  checkIsFound(kIntrinsics + 4, 0.02, 0.05);
}

TEST(RigCalibrationInWindow, FindsScalesOfTheGyroscope) {
  constexpr int kGyroscope = kImuIntrinsics + kAccelerometerIntrinsics;
  for (const int i : {0, 4, 8}) checkIsFound(kGyroscope + i, 0.02, 0.05);
}

TEST(RigCalibrationInWindow, StaysWhereTheMotionDoesNotShowIt) {
  // Two frames at one place: images of a resting rig tell nothing of its calibration.
  SyntheticWindow synthetic = makeWindow(2, 40, 0.0, always);
  SlidingWindow& window = synthetic.window;
  window.frames.pop_back();
  window.landmarks.removeFrame(1, window.cameras());
  const RigCalibration before = window.rig;
  refineRig(0.1, 0.1, 0.03, &window);
  const SolveSummary summary = solveWindow(thorough(), &window);
  ASSERT_TRUE(summary.usable);
  EXPECT_LT(minus(window.rig, before).norm(), 1e-9);
  EXPECT_NEAR(std::sqrt(summary.rig_covariance(6, 6)), 0.03, 1e-9);
}

TEST(RigCalibrationInWindow, MarginalizationKeepsWhatIsKnownOfIt) {
  SyntheticWindow synthetic = makeWindow(8, 80, 0.5, upToTheSixth);
  SlidingWindow& window = synthetic.window;
  refineRig(0.1, 0.1, 0.03, &window);
  ASSERT_TRUE(solveWindow(thorough(), &window).usable);
  for (int landmark = 40; landmark < 80; ++landmark) {
    for (std::size_t i = 0; i < window.landmarks.tracks().at(landmark).observations.size(); ++i) {
      ASSERT_GE(window.landmarks.tracks().at(landmark).host(), 1);
    }
  }
  const auto covariance = [](const SlidingWindow& w) {
    WindowSystem system(w, kHuber);
    EXPECT_TRUE(system.linearize(system.present()));
    return system.rigCovariance();
  };
  const RigMatrix before = covariance(window);
  marginalizeOldest(kHuber, &window);
  const RigMatrix after = covariance(window);
  // All that the oldest frame saw goes into the prior: nothing is lost and nothing is added.
  EXPECT_LT((after - before).norm(), 1e-6 * before.norm());
}

class LoopInWindow : public ::testing::Test {
 protected:
  LoopInWindow() : synthetic_(makeWindow(8, 60, 0.0, always)) {
    SlidingWindow& window = synthetic_.window;
    for (std::size_t i = 0; i < window.frames.size(); ++i) {
      window.frames[i].keyframe_id = 100 + static_cast<std::int64_t>(i);
    }
    T_wb_old_ = synthetic_.truth[3].T_wb *
                Pose(so3::exp(Vector3d(0.05, 0.1, -0.1)), Vector3d(0.3, -0.2, 0.4));
    match_.query_id = 105;
    match_.old_id = 7;
    match_.T_bc_old = window.rig.T_bc;
    match_.T_wb_old = T_wb_old_;
    match_.T_old_query = T_wb_old_.inverse() * synthetic_.truth[5].T_wb;
    const CameraPoses cameras = window.cameras();
    for (const auto& [id, track] : window.landmarks.tracks()) {
      const Vector3d p_w = positionInWorld(track, cameras.at(track.host()));
      const Vector3d p_c = (T_wb_old_ * window.rig.T_bc).inverse() * p_w;
      match_.features.push_back({id, p_c.normalized()});
    }
  }

  SyntheticWindow synthetic_;
  Pose T_wb_old_;
  LoopMatch match_;
};

TEST_F(LoopInWindow, RefinesTheRelativePoseFromABadGuess) {
  SlidingWindow& window = synthetic_.window;
  const Pose truth = match_.T_old_query;
  // A guess as a verification makes it, in an old world that is turned and shifted by drift.
  const Pose drift(so3::exp(0.3 * Vector3d::UnitZ()), Vector3d(4.0, 1.0, -2.0));
  match_.T_wb_old = drift * match_.T_wb_old;
  match_.T_old_query =
      match_.T_old_query * Pose(so3::exp(Vector3d(0.01, 0.02, 0.05)), Vector3d(0.1, -0.1, 0.05));
  ASSERT_TRUE(addLoop(match_, 2.0, &window));
  const SolveSummary summary = solveWindow(thorough(), &window);
  ASSERT_TRUE(summary.usable);
  ASSERT_TRUE(summary.loop.has_value());
  const std::optional<LoopEdge> edge = loopEdge(window, *summary.loop, 15);
  ASSERT_TRUE(edge.has_value());
  EXPECT_EQ(edge->query_id, 105);
  EXPECT_EQ(edge->old_id, 7);
  EXPECT_EQ(edge->inliers, 60);
  // Measurements without noise: what is left is the solver's tolerance.
  EXPECT_LT((edge->T_old_query.position - truth.position).norm(), 1e-4);
  EXPECT_LT(edge->T_old_query.rotation.angularDistance(truth.rotation), 1e-4);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(edge->covariance).eigenvalues()(0), 0.0);
}

TEST_F(LoopInWindow, DoesNotMakeTheOdometryJump) {
  SlidingWindow& window = synthetic_.window;
  match_.T_wb_old = Pose(so3::exp(0.3 * Vector3d::UnitZ()), Vector3d(4.0, 1.0, -2.0)) * T_wb_old_;
  const NavState before = window.frames.back().state.value();
  ASSERT_TRUE(addLoop(match_, 2.0, &window));
  ASSERT_TRUE(solveWindow(thorough(), &window).usable);
  EXPECT_LT(minus(window.frames.back().state.value(), before).norm(), 1e-4);
}

TEST_F(LoopInWindow, TakesAnOldCameraThatStoodOtherwiseInItsBody) {
  SlidingWindow& window = synthetic_.window;
  const Pose T_bc_old(so3::exp(Vector3d(0.2, 0.1, 1.0)), Vector3d(0.3, 0.0, -0.1));
  const Pose T_w_body = T_wb_old_ * window.rig.T_bc * T_bc_old.inverse();
  match_.T_bc_old = T_bc_old;
  match_.T_wb_old = T_w_body;
  match_.T_old_query = T_w_body.inverse() * synthetic_.truth[5].T_wb;
  const Pose truth = match_.T_old_query;
  ASSERT_TRUE(addLoop(match_, 2.0, &window));
  const SolveSummary summary = solveWindow(thorough(), &window);
  const std::optional<LoopEdge> edge = loopEdge(window, *summary.loop, 15);
  ASSERT_TRUE(edge.has_value());
  EXPECT_LT((edge->T_old_query.position - truth.position).norm(), 1e-4);
  EXPECT_LT(edge->T_old_query.rotation.angularDistance(truth.rotation), 1e-4);
}

TEST_F(LoopInWindow, IsRefusedWithoutItsQueryOrItsFeatures) {
  LoopMatch gone = match_;
  gone.query_id = 3;
  EXPECT_FALSE(addLoop(gone, 2.0, &synthetic_.window));
  LoopMatch strange = match_;
  for (MatchedFeature& feature : strange.features) feature.id += 1000;
  EXPECT_FALSE(addLoop(strange, 2.0, &synthetic_.window));
  EXPECT_FALSE(synthetic_.window.loop.has_value());
}

TEST_F(LoopInWindow, EndsWhenItsQueryLeaves) {
  SlidingWindow& window = synthetic_.window;
  match_.query_id = 101;
  ASSERT_TRUE(addLoop(match_, 2.0, &window));
  forgetLeavingLoop(&window);
  EXPECT_TRUE(window.loop.has_value());
  marginalizeOldest(kHuber, &window);
  forgetLeavingLoop(&window);
  EXPECT_FALSE(window.loop.has_value());
}

TEST_F(LoopInWindow, EndsWhenItsLandmarksHaveGone) {
  SlidingWindow& window = synthetic_.window;
  ASSERT_TRUE(addLoop(match_, 2.0, &window));
  forgetFadedLoop(60, &window);
  ASSERT_TRUE(window.loop.has_value());
  // Fifty of the sixty are not in the window any more.
  std::map<std::int64_t, BearingMeasurement> renamed;
  for (const auto& [id, measured] : window.loop->measured) {
    renamed.emplace(renamed.size() < 50 ? id + 1000 : id, measured);
  }
  window.loop->measured = {renamed.begin(), renamed.end()};
  forgetFadedLoop(10, &window);
  EXPECT_TRUE(window.loop.has_value());
  forgetFadedLoop(11, &window);
  EXPECT_FALSE(window.loop.has_value());
  EXPECT_TRUE(solveWindow(thorough(), &window).usable);
}

TEST(MotionOnly, BringsTheNewestFramesBackAndMovesNothingElse) {
  SyntheticWindow synthetic = makeWindow(8, 60, 0.0, always);
  SlidingWindow& window = synthetic.window;
  for (std::size_t i = 0; i < 6; ++i) window.frames[i].keyframe_id = static_cast<int>(i);
  ASSERT_TRUE(solveWindow(thorough(), &window).usable);
  for (WindowFrame& frame : window.frames) {
    frame.covariance = 1e-4 * Matrix15d::Identity();
  }
  const std::vector<NavState> before = window.values().states;
  testing::Random random(3);
  for (std::size_t i = 6; i < 8; ++i) {
    Vector15d d = Vector15d::Zero();
    for (int k = 0; k < 9; ++k) d(k) = 0.02 * random.normal();
    window.frames[i].state.setValue(plus(before[i], d));
  }
  const SolveSummary summary = solveNewestFrames(thorough(), &window);
  ASSERT_TRUE(summary.usable);
  EXPECT_EQ(summary.observations, 120);
  const std::vector<NavState> after = window.values().states;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(minus(after[i], before[i]).norm(), 0.0);
  for (std::size_t i = 6; i < 8; ++i) EXPECT_LT(minus(after[i], before[i]).head<9>().norm(), 1e-4);
  // Larger than where it came from: the IMU adds, and the images are not counted.
  EXPECT_GT(summary.newest_covariance.diagonal().head<9>().minCoeff(), 1e-4);
}

}  // namespace
}  // namespace vins::estimator
