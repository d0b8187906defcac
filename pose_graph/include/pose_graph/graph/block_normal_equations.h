#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pose_graph/graph/block_cholesky.h"

namespace vins::pose_graph {

/// Normal equations H x = -g of a graph: one block of `kDim` unknowns per vertex, one block row per
/// edge. The pattern is fixed at construction, where the vertices are ordered by approximate
/// minimum degree (P. Amestoy, T. Davis, I. Duff, 1996) block by block, so that filling,
/// factorizing and solving touch no memory but their own. Made for kDim = 3, 4 and 6.
template <int kDim>
class BlockNormalEquations {
 public:
  using Block = typename BlockMatrix<kDim>::Block;
  using Segment = Eigen::Matrix<double, kDim, 1>;

  static constexpr int kConstant = -1;  ///< in place of a vertex that is no unknown

  /// An edge's share in H and g; blocks of constant vertices are ignored.
  struct Contribution {
    Block H_ii, H_ij, H_jj;
    Segment g_i, g_j;
  };

  /// `edges`: pairs (i, j), i != j, of unknowns' numbers below `unknowns`, or kConstant.
  BlockNormalEquations(int unknowns, std::vector<std::pair<int, int>> edges);

  /// Sets H and g to zero.
  void setZero();

  /// Adds the share of edge number `edge`.
  void add(std::size_t edge, const Contribution& share);

  /// g, blocks in the order of the unknowns' numbers.
  const Eigen::VectorXd& gradient() const { return gradient_; }

  /// Diagonal of H.
  Eigen::VectorXd diagonal() const;

  /// x^T H x.
  double curvature(const Eigen::VectorXd& x) const;

  /// Factorizes H + damping diag(H). False where that is not positive definite in numbers.
  bool factorize(double damping = 0.0);

  /// (H + damping diag(H))^-1 b by the last factorization.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  void orderVertices();
  void makePattern();
  Eigen::VectorXd ordered(const Eigen::VectorXd& x) const;

  int unknowns_ = 0;
  std::vector<std::pair<int, int>> edges_;
  std::vector<int> position_;             ///< of each unknown in the order of elimination
  std::vector<std::size_t> edge_places_;  ///< of each edge's block below the diagonal
  BlockMatrix<kDim> H_;                   ///< in the order of elimination
  Eigen::VectorXd gradient_;
  std::optional<BlockCholesky<kDim>> cholesky_;
};

extern template class BlockNormalEquations<3>;
extern template class BlockNormalEquations<4>;
extern template class BlockNormalEquations<6>;

}  // namespace vins::pose_graph
