#include "pose_graph/graph/six_dof.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "noisy_sphere.h"
#include "pose_graph/graph/six_dof_start.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::pose_graph {
namespace {

using testing::noisySphere;

constexpr MinimizerMethod kMethods[] = {
    MinimizerMethod::kGaussNewton, MinimizerMethod::kLevenbergMarquardt, MinimizerMethod::kDogleg};

double difference(const Pose& a, const Pose& b) { return se3::log(a.inverse() * b).norm(); }

template <int kDim>
void checkJacobians(const Pose& a, const Pose& b, const Pose& T_ij) {
  using Model = RelativePoseModel<kDim>;
  typename Model::Edge edge;
  edge.T_ji = T_ij.inverse();
  edge.square_root = Model::Block::Identity() + 0.3 * Model::Block::Ones();
  typename Model::Segment r;
  typename Model::Block J_a, J_b;
  Model::evaluate(edge, a, b, &r, &J_a, &J_b);
  const auto by_a = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
    typename Model::Segment e;
    Model::evaluate(edge, Model::plus(a, d), b, &e, nullptr, nullptr);
    return e;
  };
  const auto by_b = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
    typename Model::Segment e;
    Model::evaluate(edge, a, Model::plus(b, d), &e, nullptr, nullptr);
    return e;
  };
  // Errors of size 10: truncation of about 1e-12 times a fifth derivative of up to some hundreds,
  // rounding of 1e-14 / 1e-3.
  EXPECT_LT((J_a - vins::testing::numericJacobian(by_a, kDim)).norm(), 1e-9);
  EXPECT_LT((J_b - vins::testing::numericJacobian(by_b, kDim)).norm(), 1e-9);
}

TEST(RelativePoseModel, JacobiansAgreeWithNumericDifferences) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto pose = [&](bool planar) {
    se3::Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = normal(random) * (k < 3 ? 2.0 : 0.7);
    if (planar) xi[2] = xi[3] = xi[4] = 0.0;
    return se3::exp(xi);
  };
  for (int i = 0; i < 20; ++i) {
    // An error of less than 2 rad: the logarithm has its edge at pi.
    const Pose a = pose(false), b = pose(false);
    const Pose planar_a = pose(true), planar_b = pose(true);
    const Pose small = se3::exp(0.5 * se3::log(pose(false)));
    checkJacobians<6>(a, b, a.inverse() * b * small);
    checkJacobians<3>(planar_a, planar_b, pose(true));
  }
}

TEST(RelativePoseModel, PlanarErrorIsTheSpatialOneOfAPlane) {
  const auto planar = [](double x, double y, double theta) {
    return Pose(so3::exp({0.0, 0.0, theta}), {x, y, 0.0});
  };
  RelativePoseModel<3>::Edge edge;
  edge.T_ji = planar(1.0, 2.0, 0.3).inverse();
  RelativePoseModel<3>::Segment r;
  RelativePoseModel<3>::evaluate(edge, Pose(), planar(1.0, 2.0, 0.8), &r, nullptr, nullptr);
  EXPECT_NEAR(r.head<2>().norm(), 0.0, 1e-15);
  EXPECT_NEAR(r[2], 0.5, 1e-15);
}

TEST(RobustKernelTest, WeightIsTheDerivativeOfTheCost) {
  for (const KernelType type :
       {KernelType::kNone, KernelType::kHuber, KernelType::kCauchy, KernelType::kGemanMcClure}) {
    const RobustKernel kernel{type, 1.7};
    EXPECT_EQ(kernel.cost(0.0), 0.0);
    EXPECT_EQ(kernel.weight(0.0), 1.0);
    for (const double s : {0.5, 2.0, 4.0, 30.0}) {
      const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, kernel.cost(s + d[0]));
      };
      // Truncation of 1e-12, rounding of 1e-14 / 1e-3.
      EXPECT_NEAR(kernel.weight(s), vins::testing::numericJacobian(f, 1)(0, 0), 1e-10) << s;
    }
  }
  EXPECT_THROW((RobustKernel{KernelType::kHuber, -1.0}.validate()), InputError);
}

/// Whether the graph is planar.
class SixDof : public ::testing::TestWithParam<bool> {};

TEST_P(SixDof, NoiseFreeGraphIsFoundWithCostZero) {
  const RelativePoseGraph truth = noisySphere(8, 12, 0.0, GetParam(), 1);
  for (const MinimizerMethod method : kMethods) {
    RelativePoseGraph graph = truth;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (std::size_t i = 1; i < graph.poses.size(); ++i) {
      se3::Vector6d xi = se3::Vector6d::NullaryExpr([&] { return 0.05 * normal(random); });
      if (GetParam()) xi[2] = xi[3] = xi[4] = 0.0;
      graph.poses[i].T_wi = graph.poses[i].T_wi * se3::exp(xi);
    }
    SixDofOptions options;
    options.minimizer.method = method;
    const MinimizerSummary summary = optimizeSixDof(&graph, options);
    EXPECT_EQ(summary.status, MinimizerStatus::kConverged);
    // The last step promised less than the floor of 1e-16, and there steps keep their promises.
    EXPECT_LT(summary.final_cost, 1e-16);
    for (std::size_t i = 0; i < graph.poses.size(); ++i) {
      // Errors of at most the root of that in each edge, along a chain of some ten.
      EXPECT_LT(difference(graph.poses[i].T_wi, truth.poses[i].T_wi), 1e-6);
    }
  }
}

TEST_P(SixDof, StartsOfANoiseFreeGraphAreTheTruth) {
  const RelativePoseGraph truth = noisySphere(8, 12, 0.0, GetParam(), 1);
  for (int start = 0; start < 3; ++start) {
    RelativePoseGraph graph = truth;
    for (std::size_t i = 1; i < graph.poses.size(); ++i) graph.poses[i].T_wi = Pose();
    if (start == 0) startFromOdometry(&graph);
    if (start == 1) startFromSpanningTree(&graph);
    const bool solved = start != 2 || startFromChordalRotations(&graph);
    EXPECT_TRUE(solved);
    for (std::size_t i = 0; i < graph.poses.size(); ++i) {
      // Rounding, through chains of a hundred poses and a linear system.
      EXPECT_LT(difference(graph.poses[i].T_wi, truth.poses[i].T_wi), 1e-10) << start;
    }
  }
}

TEST_P(SixDof, MethodsAndStartsAgreeOnANoisyGraph) {
  const RelativePoseGraph noisy = noisySphere(12, 20, 0.05, GetParam(), 2);
  double reference = -1.0;
  for (const MinimizerMethod method : kMethods) {
    for (const bool chordal : {false, true}) {
      RelativePoseGraph graph = noisy;
      if (chordal) {
        EXPECT_TRUE(startFromChordalRotations(&graph));
      } else {
        startFromSpanningTree(&graph);
      }
      SixDofOptions options;
      options.minimizer.method = method;
      const MinimizerSummary summary = optimizeSixDof(&graph, options);
      EXPECT_EQ(summary.status, MinimizerStatus::kConverged);
      if (reference < 0.0) reference = summary.final_cost;
      // One minimum: all end where a step changes the cost by less than 1e-10.
      EXPECT_NEAR(summary.final_cost, reference, 1e-6 * reference);
    }
  }
  // Twice the cost is chi-square distributed with as many degrees of freedom as there are errors
  // beyond the unknowns: its standard deviation is sqrt(2 n), of which six are allowed.
  const int size = GetParam() ? 3 : 6;
  const double freedom = size * (double(noisy.edges.size()) - double(noisy.poses.size()) + 1.0);
  EXPECT_NEAR(2.0 * reference, freedom, 6.0 * std::sqrt(2.0 * freedom));
}

TEST_P(SixDof, RobustKernelsHoldWrongEdgesBack) {
  const RelativePoseGraph clean = noisySphere(8, 12, 0.01, GetParam(), 3);
  RelativePoseGraph spoilt = clean;
  for (const int k : {10, 40, 60}) {
    RelativePoseEdge wrong = spoilt.edges[std::size_t(k)];
    wrong.to = (wrong.from + 48) % 96;
    spoilt.edges.push_back(wrong);
  }
  const auto error = [&](KernelType type) {
    RelativePoseGraph graph = spoilt;
    SixDofOptions options;
    options.kernel = {type, 3.0};
    EXPECT_NE(optimizeSixDof(&graph, options).status, MinimizerStatus::kFailed);
    double worst = 0.0;
    for (std::size_t i = 0; i < graph.poses.size(); ++i) {
      worst = std::max(worst, (graph.poses[i].T_wi.position - clean.poses[i].T_wi.position).norm());
    }
    return worst;
  };
  const double plain = error(KernelType::kNone);
  for (const KernelType type :
       {KernelType::kHuber, KernelType::kCauchy, KernelType::kGemanMcClure}) {
    EXPECT_LT(error(type), 0.5 * plain);
  }
}

TEST_P(SixDof, FixedPosesStayAndTheRestFollows) {
  RelativePoseGraph graph = noisySphere(4, 8, 0.0, GetParam(), 4);
  const RelativePoseGraph truth = graph;
  const Pose moved(so3::exp({0.0, 0.0, 0.7}), {3.0, 4.0, 0.0});
  graph.poses[5].fixed = true;
  graph.poses[5].T_wi = moved * graph.poses[5].T_wi;
  optimizeSixDof(&graph, {});
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    // The costs' tolerance leaves errors of about the root of rounding.
    EXPECT_LT(difference(graph.poses[i].T_wi, moved * truth.poses[i].T_wi), 1e-7) << i;
  }
}

TEST_P(SixDof, PartsThatNothingJoinsAreSolvedEachByItself) {
  RelativePoseGraph graph = noisySphere(4, 8, 0.02, GetParam(), 5);
  RelativePoseGraph alone = graph;
  const auto count = graph.poses.size();
  for (std::size_t i = 0; i < count; ++i) {
    graph.poses.push_back(graph.poses[i]);
    graph.poses.back().id += 1000;
  }
  const auto edges = graph.edges;
  for (RelativePoseEdge edge : edges) {
    edge.from += 1000;
    edge.to += 1000;
    graph.edges.push_back(edge);
  }
  const double twice = optimizeSixDof(&graph, {}).final_cost;
  const double once = optimizeSixDof(&alone, {}).final_cost;
  // As exact as the minimizer's tolerance.
  EXPECT_NEAR(twice, 2.0 * once, 1e-8 * twice);
}

INSTANTIATE_TEST_SUITE_P(Graphs, SixDof, ::testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "Planar" : "Spatial");
});

TEST(SixDofInput, SingularInformationIsAllowedNegativeIsNot) {
  RelativePoseGraph graph = noisySphere(4, 8, 0.02, false, 6);
  graph.edges[20].information(2, 2) = 0.0;
  EXPECT_EQ(optimizeSixDof(&graph, {}).status, MinimizerStatus::kConverged);
  graph.edges[20].information(2, 2) = -1.0;
  const std::string ends =
      std::to_string(graph.edges[20].from) + " to " + std::to_string(graph.edges[20].to);
  try {
    optimizeSixDof(&graph, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(ends), std::string::npos) << error.what();
  }
}

TEST(SixDofInput, RefusesEdgesAndIdsThatMeanNothing) {
  const RelativePoseGraph good = noisySphere(2, 8, 0.02, false, 7);
  RelativePoseGraph graph = good;
  graph.edges[3].to = 999;
  EXPECT_THROW(optimizeSixDof(&graph, {}), InputError);
  graph = good;
  graph.edges[3].to = graph.edges[3].from;
  EXPECT_THROW(startFromSpanningTree(&graph), InputError);
  graph = good;
  graph.poses[3].id = graph.poses[4].id;
  EXPECT_THROW(startFromChordalRotations(&graph), InputError);
  graph = good;
  graph.edges.erase(graph.edges.begin());
  EXPECT_THROW(startFromOdometry(&graph), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
