#include "pose_graph/graph/block_normal_equations.h"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace vins::pose_graph {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A graph with constant ends and a doubled edge, beside the same as a dense matrix.
template <int kDim>
struct Example {
  using Equations = BlockNormalEquations<kDim>;
  static constexpr int kUnknowns = 7;

  Example()
      : pairs{{0, 1},
              {1, 2},
              {3, 2},
              {3, 4},
              {0, 4},
              {5, 6},
              {6, 0},
              {4, 0},
              {Equations::kConstant, 5},
              {2, Equations::kConstant}},
        equations(kUnknowns, pairs),
        H(MatrixXd::Zero(kDim * kUnknowns, kDim * kUnknowns)),
        g(VectorXd::Zero(kDim * kUnknowns)) {
    std::srand(1);  // of Eigen's random matrices
    equations.setZero();
    for (std::size_t k = 0; k < pairs.size(); ++k) addEdge(k);
  }

  void addEdge(std::size_t k) {
    using Block = typename Equations::Block;
    using Segment = typename Equations::Segment;
    const Block J_i = Block::Random(), J_j = Block::Random();
    const Segment r = Segment::Random();
    equations.add(k, {J_i.transpose() * J_i, J_i.transpose() * J_j, J_j.transpose() * J_j,
                      J_i.transpose() * r, J_j.transpose() * r});
    MatrixXd J = MatrixXd::Zero(kDim, kDim * kUnknowns);
    if (pairs[k].first >= 0) J.middleCols(kDim * pairs[k].first, kDim) = J_i;
    if (pairs[k].second >= 0) J.middleCols(kDim * pairs[k].second, kDim) = J_j;
    H += J.transpose() * J;
    g += J.transpose() * r;
  }

  std::vector<std::pair<int, int>> pairs;
  Equations equations;
  MatrixXd H;
  VectorXd g;
};

template <typename Size>
class BlockNormalEquationsTest : public ::testing::Test {};
using Sizes = ::testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>,
                               std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(BlockNormalEquationsTest, Sizes);

TYPED_TEST(BlockNormalEquationsTest, AreThoseOfTheDenseMatrix) {
  Example<TypeParam::value> example;
  // Sums of numbers below 1, tens of them.
  EXPECT_LT((example.equations.gradient() - example.g).norm(), 1e-13);
  EXPECT_LT((example.equations.diagonal() - example.H.diagonal()).norm(), 1e-13);
  const VectorXd x = VectorXd::Random(example.g.size());
  EXPECT_NEAR(example.equations.curvature(x), x.dot(example.H * x), 1e-12);
}

TYPED_TEST(BlockNormalEquationsTest, SolutionsFulfilTheDenseEquations) {
  Example<TypeParam::value> example;
  for (const double damping : {0.0, 0.5}) {
    ASSERT_TRUE(example.equations.factorize(damping));
    const VectorXd x = example.equations.solve(example.g);
    MatrixXd damped = example.H;
    damped.diagonal() *= 1.0 + damping;
    // Rounding times a condition number of random 6x6 blocks in a chain: up to about 1e5.
    EXPECT_LT((damped * x - example.g).norm(), 1e-9);
  }
  // Damping leaves the equations as they were.
  EXPECT_LT((example.equations.diagonal() - example.H.diagonal()).norm(), 1e-13);
}

TYPED_TEST(BlockNormalEquationsTest, SaysWhereThereIsNoFactor) {
  Example<TypeParam::value> example;
  example.equations.setZero();
  EXPECT_FALSE(example.equations.factorize());
}

}  // namespace
}  // namespace vins::pose_graph
