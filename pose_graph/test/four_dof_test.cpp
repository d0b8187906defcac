#include "pose_graph/graph/four_dof.h"

#include <chrono>
#include <random>

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "pose_graph/graph/heading.h"
#include "synthetic_keyframes.h"
#include "vins_core/input_error.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::pose_graph {
namespace {

using Block = FourDofModel::Block;
using Segment = FourDofModel::Segment;
using State = FourDofModel::State;
using testing::difference;
using testing::SyntheticKeyframes;

const Eigen::Quaterniond kNoseUp = so3::exp(Eigen::Vector3d(0.0, -M_PI / 2.0, 0.0));

class FourDofModelTest : public ::testing::Test {
 protected:
  Eigen::Vector3d vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }
  State state() { return {3.0 * vector(), 2.0 * normal_(random_)}; }
  FourDofModel::Edge edge() { return {0, 1, vector(), normal_(random_), 3.0, 20.0, {}}; }

  std::mt19937_64 random_{5};
  std::normal_distribution<double> normal_;
};

TEST_F(FourDofModelTest, JacobiansAgreeWithNumericDifferences) {
  for (int i = 0; i < 20; ++i) {
    const State a = state(), b = state();
    const auto measured = edge();
    Segment r;
    Block J_a, J_b;
    FourDofModel::evaluate(measured, a, b, &r, &J_a, &J_b);
    const auto by_a = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      Segment e;
      FourDofModel::evaluate(measured, FourDofModel::plus(a, d), b, &e, nullptr, nullptr);
      return e;
    };
    const auto by_b = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      Segment e;
      FourDofModel::evaluate(measured, a, FourDofModel::plus(b, d), &e, nullptr, nullptr);
      return e;
    };
    // Differences of errors of size 10: rounding 1e-15 * 10 / 1e-3, truncation 1e-12 * 10 / 30.
    EXPECT_LT((J_a - vins::testing::numericJacobian(by_a, 4)).norm(), 1e-10);
    EXPECT_LT((J_b - vins::testing::numericJacobian(by_b, 4)).norm(), 1e-10);
  }
}

TEST_F(FourDofModelTest, ErrorDoesNotChangeWhenTheMapIsMoved) {
  const State a = state(), b = state();
  const auto measured = edge();
  const double yaw = 1.3;
  const Eigen::Vector3d shift(1.0, 2.0, 3.0);
  const auto moved = [&](const State& s) {
    return State{yawRotation(yaw) * s.position + shift, s.yaw + yaw};
  };
  Segment r, r_moved;
  FourDofModel::evaluate(measured, a, b, &r, nullptr, nullptr);
  FourDofModel::evaluate(measured, moved(a), moved(b), &r_moved, nullptr, nullptr);
  // Rounding of coordinates of 10 m, times weights of 20.
  EXPECT_LT((r - r_moved).norm(), 1e-12);
}

KeyframeGraph optimized(KeyframeGraph graph, const FourDofOptions& options = {}) {
  const FourDofResult result = optimizeFourDof(graph, options);
  EXPECT_EQ(result.summary.status, MinimizerStatus::kConverged);
  graph.apply(result.correction);
  return graph;
}

TEST(FourDof, PerfectOdometryAndLoopsStayAsTheyAre) {
  const SyntheticKeyframes run(60, 20, 0.0, 1, kNoseUp);
  KeyframeGraph graph;
  run.addTo(&graph);
  for (std::size_t i = 20; i < 60; i += 5) graph.addLoopEdge(run.loop(i - 20, i));
  const FourDofResult result = optimizeFourDof(graph, {});
  // Whitened rounding: (1e-14 m / 0.015 m)^2 in some hundred errors.
  EXPECT_LT(result.summary.initial_cost, 1e-18);
  EXPECT_LT(testing::positionError(optimized(graph), run.truth), 1e-12);
}

TEST(FourDof, LoopsTakeTheDriftAway) {
  const SyntheticKeyframes run(200, 20, 0.02, 2, kNoseUp);
  KeyframeGraph graph(testing::exactLoops());
  run.addTo(&graph);
  for (std::size_t i = 20; i < 200; i += 4) graph.addLoopEdge(run.loop(i - 20, i));
  // 20 steps of 0.02 m on three axes are 0.15 m.
  EXPECT_GT(testing::loopError(graph, run.truth), 0.1);
  const KeyframeGraph after = optimized(graph);
  // Loops that are exact, and trusted far more than the odometry, are met to less than their sigma.
  EXPECT_LT(testing::loopError(after, run.truth), 0.005);
  for (const auto& [id, vertex] : after.vertices()) {
    // Roll and pitch are the odometry's: the map's vertical stays where it was in the body.
    const Eigen::Vector3d up_map = vertex.T_mb.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d up_odometry = vertex.T_wb.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    EXPECT_LT((up_map - up_odometry).norm(), 1e-12) << id;
  }
}

TEST(FourDof, WhatIsOlderThanTheOldestLoopStays) {
  const SyntheticKeyframes run(60, 20, 0.02, 3);
  KeyframeGraph graph;
  run.addTo(&graph);
  graph.addLoopEdge(run.loop(30, 50));
  const KeyframeGraph after = optimized(graph);
  for (const auto& [id, vertex] : graph.vertices()) {
    const double moved = difference(vertex.T_mb, after.vertices().at(id).T_mb);
    EXPECT_EQ(moved > 0.0, id > 30) << id;
  }
}

TEST(FourDof, WithoutLoopsNothingIsDone) {
  KeyframeGraph graph;
  SyntheticKeyframes(10, 20, 0.1, 4).addTo(&graph);
  const FourDofResult result = optimizeFourDof(graph, {});
  EXPECT_EQ(result.summary.iterations, 0);
  EXPECT_TRUE(result.correction.T_mw.empty());
}

TEST(FourDof, ResultIsTheSameWhereverTheOdometryBegan) {
  const SyntheticKeyframes run(80, 20, 0.02, 5, kNoseUp);
  KeyframeGraph here, there;
  const Pose T_there_here(yawRotation(2.0), {30.0, -20.0, 10.0});
  run.addTo(&here);
  for (int i = 0; i < 80; ++i) {
    const Stamp stamp = SyntheticKeyframes::kPeriod * (i + 1);
    there.addKeyframe(i, 0, stamp, T_there_here * run.odometry[std::size_t(i)]);
  }
  for (std::size_t i = 25; i < 80; i += 7) {
    here.addLoopEdge(run.loop(i - 20, i));
    there.addLoopEdge(run.loop(i - 20, i));
  }
  here = optimized(here);
  there = optimized(there);
  for (const auto& [id, vertex] : here.vertices()) {
    // Both are solved to the same steps; only rounding differs, of coordinates of 50 m.
    EXPECT_LT(difference(T_there_here * vertex.T_mb, there.vertices().at(id).T_mb), 1e-9) << id;
  }
}

TEST(FourDof, HuberHoldsAWrongLoopBack) {
  const SyntheticKeyframes run(100, 20, 0.01, 6);
  KeyframeGraph graph;
  run.addTo(&graph);
  for (std::size_t i = 20; i < 100; i += 4) graph.addLoopEdge(run.loop(i - 20, i));
  LoopEdge wrong = run.loop(5, 70);
  wrong.T_old_query.position += Eigen::Vector3d(4.0, 3.0, 0.0);
  graph.addLoopEdge(wrong);
  FourDofOptions squares;
  squares.loop_kernel.type = KernelType::kNone;
  const double robust = testing::positionError(optimized(graph), run.truth);
  const double plain = testing::positionError(optimized(graph, squares), run.truth);
  EXPECT_LT(robust, 0.5 * plain);
}

/// The same problem for Ceres, differentiated by itself: an independent judge of the minimum.
struct CeresError {
  template <typename T>
  bool operator()(const T* from, const T* to, T* r) const {
    const T c = ceres::cos(from[3]), s = ceres::sin(from[3]);
    const T x = to[0] - from[0], y = to[1] - from[1];
    r[0] = (c * x + s * y - edge.position.x()) / edge.position_sigma;
    r[1] = (c * y - s * x - edge.position.y()) / edge.position_sigma;
    r[2] = (to[2] - from[2] - edge.position.z()) / edge.position_sigma;
    r[3] = (to[3] - from[3] - edge.yaw) / edge.yaw_sigma;
    return true;
  }
  HeadingEdge edge;
};

TEST(FourDof, CeresFindsTheSameCost) {
  const SyntheticKeyframes run(2000, 100, 0.01, 7, kNoseUp);
  KeyframeGraph graph;
  run.addTo(&graph);
  for (std::size_t i = 100; i < 2000; i += 10) graph.addLoopEdge(run.loop(i - 100, i));
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::array<double, 4>> states;
  for (const auto& item : graph.vertices()) {
    const Eigen::Vector3d& p = item.second.T_mb.position;
    states.push_back({p.x(), p.y(), p.z(), 0.0});
  }
  ceres::Problem problem;
  for (const HeadingEdge& edge : graph.edges()) {
    // Huber's width of loop_kernel; ceres::HuberLoss takes it in the same sense.
    ceres::LossFunction* loss = edge.is_loop ? new ceres::HuberLoss(2.0) : nullptr;
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<CeresError, 4, 4, 4>(new CeresError{edge}), loss,
        states[std::size_t(edge.from)].data(), states[std::size_t(edge.to)].data());
  }
  problem.SetParameterBlockConstant(states[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-9;
  options.max_num_iterations = 100;
  ceres::Solver::Summary theirs;
  ceres::Solve(options, &problem, &theirs);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  RecordProperty("ceres_seconds", std::to_string(seconds.count()));
  FourDofOptions exact;
  exact.minimizer.cost_tolerance = 1e-9;
  const FourDofResult ours = optimizeFourDof(graph, exact);
  EXPECT_NEAR(ours.summary.initial_cost, theirs.initial_cost, 1e-9 * theirs.initial_cost);
  // Ours ends where a step promises less than 1e-9 of the cost; the steps shrink by a constant
  // factor.
  EXPECT_NEAR(ours.summary.final_cost, theirs.final_cost, 1e-7 * theirs.final_cost);
  // And the default stops near enough.
  const FourDofResult quick = optimizeFourDof(graph, {});
  EXPECT_NEAR(quick.summary.final_cost, theirs.final_cost, 1e-5 * theirs.final_cost);
}

TEST(FourDof, RefusesOptionsOutOfRange) {
  FourDofOptions options;
  options.loop_kernel.width = 0.0;
  EXPECT_THROW(optimizeFourDof(KeyframeGraph(), options), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
