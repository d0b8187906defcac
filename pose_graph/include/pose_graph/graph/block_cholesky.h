#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/StdVector>

namespace vins::pose_graph {

/// Lower triangle of a symmetric matrix of kDim x kDim blocks, column by column.
template <int kDim>
struct BlockMatrix {
  using Block = Eigen::Matrix<double, kDim, kDim>;
  using Blocks = std::vector<Block, Eigen::aligned_allocator<Block>>;

  std::vector<std::size_t> begin;  ///< of each column's blocks in `rows`, and the end of the last
  std::vector<int> rows;           ///< of the blocks below the diagonal, rising in each column
  Blocks below;                    ///< the blocks below the diagonal
  Blocks diagonal;                 ///< symmetric; all of it is stored

  int size() const { return static_cast<int>(diagonal.size()); }
};

/// L L^T of a sparse symmetric positive definite matrix of small dense blocks, left-looking (T. A.
/// Davis, "Direct methods for sparse linear systems", SIAM 2006, chapter 4, in blocks). The
/// pattern is analysed once; factorizing again allocates nothing. Keeps the order of the rows: who
/// wants little fill orders them before. Made for kDim = 3, 4 and 6.
template <int kDim>
class BlockCholesky {
 public:
  using Block = typename BlockMatrix<kDim>::Block;

  /// Takes the pattern of A; its numbers do not matter.
  explicit BlockCholesky(const BlockMatrix<kDim>& A);

  /// Factorizes A + damping diag(A). False where a pivot is not positive or no number.
  bool factorize(const BlockMatrix<kDim>& A, double damping);

  /// Replaces b by the solution x of A x = b.
  void solve(Eigen::VectorXd* b) const;

  /// Blocks below the diagonal of the factor: a measure of fill.
  std::size_t blocksBelowDiagonal() const { return L_.rows.size(); }

 private:
  void loadColumn(const BlockMatrix<kDim>& A, int j, double damping);
  void subtractColumn(int k);
  bool finishColumn(int j);
  void enqueue(int k);

  BlockMatrix<kDim> L_;                        ///< the diagonal holds the inverses of the factor's
  typename BlockMatrix<kDim>::Blocks column_;  ///< the column at work, by row

  // Finished columns k by the row of their next block that has not been used yet: lists linked by
  // next_, which begin at first_.
  std::vector<int> first_, next_;
  std::vector<std::size_t> used_;
};

extern template class BlockCholesky<3>;
extern template class BlockCholesky<4>;
extern template class BlockCholesky<6>;

}  // namespace vins::pose_graph
