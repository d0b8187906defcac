#include "pose_graph/graph/block_cholesky.h"

#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace vins::pose_graph {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A random pattern with dominant diagonal, and the same as a dense matrix.
template <int kDim>
struct Example {
  Example(int size, int blocks, std::uint64_t seed)
      : dense(MatrixXd::Zero(kDim * size, kDim * size)) {
    std::mt19937_64 random(seed);
    const auto number = [&random] { return 1e-3 * static_cast<double>(random() % 2000) - 1.0; };
    std::set<std::pair<int, int>> places;  // column, row
    for (int k = 0; k < blocks; ++k) {
      const int i = static_cast<int>(random() % std::uint64_t(size));
      const int j = static_cast<int>(random() % std::uint64_t(size));
      if (i != j) places.emplace(std::min(i, j), std::max(i, j));
    }
    A.begin.assign(1, 0);
    auto place = places.begin();
    for (int j = 0; j < size; ++j) {
      A.diagonal.push_back(10.0 * kDim * BlockMatrix<kDim>::Block::Identity());
      for (; place != places.end() && place->first == j; ++place) {
        A.rows.push_back(place->second);
        A.below.push_back(BlockMatrix<kDim>::Block::NullaryExpr(number));
        dense.block(kDim * place->second, kDim * j, kDim, kDim) = A.below.back();
        dense.block(kDim * j, kDim * place->second, kDim, kDim) = A.below.back().transpose();
      }
      A.begin.push_back(A.rows.size());
    }
    dense.diagonal().setConstant(10.0 * kDim);
  }

  BlockMatrix<kDim> A;
  MatrixXd dense;
};

template <typename Size>
class BlockCholeskyTest : public ::testing::Test {};
using Sizes = ::testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>,
                               std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(BlockCholeskyTest, Sizes);

TYPED_TEST(BlockCholeskyTest, SolvesWhatTheDenseMatrixSays) {
  constexpr int kDim = TypeParam::value;
  for (const int blocks : {0, 10, 30, 60}) {
    const Example<kDim> example(25, blocks, 1 + static_cast<std::uint64_t>(blocks));
    BlockCholesky<kDim> cholesky(example.A);
    EXPECT_GE(cholesky.blocksBelowDiagonal(), example.A.rows.size());
    // Twice: a factorization leaves nothing behind for the next.
    for (const double damping : {0.5, 0.0}) {
      ASSERT_TRUE(cholesky.factorize(example.A, damping));
      MatrixXd damped = example.dense;
      damped.diagonal() *= 1.0 + damping;
      const VectorXd b = VectorXd::LinSpaced(kDim * 25, -1.0, 1.0);
      VectorXd x = b;
      cholesky.solve(&x);
      // Well conditioned: rounding of some hundred numbers of about 1.
      EXPECT_LT((damped * x - b).norm(), 1e-13);
    }
  }
}

TYPED_TEST(BlockCholeskyTest, SaysWhereAPivotIsNotPositive) {
  constexpr int kDim = TypeParam::value;
  Example<kDim> example(10, 20, 5);
  BlockCholesky<kDim> cholesky(example.A);
  example.A.diagonal[7](1, 1) = -1.0;
  EXPECT_FALSE(cholesky.factorize(example.A, 0.0));
  example.A.diagonal[7](1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(cholesky.factorize(example.A, 0.0));
}

}  // namespace
}  // namespace vins::pose_graph
