#include "pose_graph/graph/block_cholesky.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace vins::pose_graph {
namespace {

constexpr int kNone = -1;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Rows of L's columns below the diagonal: A's own, and those of each column k that has its first
/// block below the diagonal in this one (Davis 2006, theorem 4.3 and section 4.1).
template <int kDim>
std::vector<std::vector<int>> patternOfFactor(const BlockMatrix<kDim>& A) {
  std::vector<std::vector<int>> rows(index(A.size()));
  for (int j = 0; j < A.size(); ++j) {
    std::vector<int>& column = rows[index(j)];
    column.insert(column.end(), A.rows.begin() + static_cast<std::ptrdiff_t>(A.begin[index(j)]),
                  A.rows.begin() + static_cast<std::ptrdiff_t>(A.begin[index(j) + 1]));
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    if (column.empty()) continue;
    // Handed to the parent at once; there duplicates are taken out.
    std::vector<int>& parent = rows[index(column.front())];
    parent.insert(parent.end(), column.begin() + 1, column.end());
  }
  return rows;
}

}  // namespace

template <int kDim>
BlockCholesky<kDim>::BlockCholesky(const BlockMatrix<kDim>& A)
    : column_(index(A.size()), Block::Zero()),
      first_(index(A.size()), kNone),
      next_(index(A.size()), kNone),
      used_(index(A.size()), 0) {
  L_.begin.push_back(0);
  for (const std::vector<int>& column : patternOfFactor(A)) {
    L_.rows.insert(L_.rows.end(), column.begin(), column.end());
    L_.begin.push_back(L_.rows.size());
  }
  L_.below.resize(L_.rows.size());
  L_.diagonal.resize(index(A.size()));
}

template <int kDim>
bool BlockCholesky<kDim>::factorize(const BlockMatrix<kDim>& A, double damping) {
  std::fill(first_.begin(), first_.end(), kNone);
  for (int j = 0; j < A.size(); ++j) {
    loadColumn(A, j, damping);
    for (int k = first_[index(j)]; k != kNone;) {
      const int next = next_[index(k)];
      subtractColumn(k);
      k = next;
    }
    if (!finishColumn(j)) return false;
  }
  return true;
}

template <int kDim>
void BlockCholesky<kDim>::loadColumn(const BlockMatrix<kDim>& A, int j, double damping) {
  for (std::size_t b = L_.begin[index(j)]; b < L_.begin[index(j) + 1]; ++b) {
    column_[index(L_.rows[b])].setZero();
  }
  for (std::size_t b = A.begin[index(j)]; b < A.begin[index(j) + 1]; ++b) {
    column_[index(A.rows[b])] = A.below[b];
  }
  column_[index(j)] = A.diagonal[index(j)];
  column_[index(j)].diagonal() *= 1.0 + damping;
}

template <int kDim>
void BlockCholesky<kDim>::subtractColumn(int k) {
  const std::size_t end = L_.begin[index(k) + 1];
  const Block transposed = L_.below[used_[index(k)]].transpose();
  for (std::size_t b = used_[index(k)]; b < end; ++b) {
    column_[index(L_.rows[b])].noalias() -= L_.below[b].lazyProduct(transposed);
  }
  ++used_[index(k)];
  enqueue(k);
}

template <int kDim>
bool BlockCholesky<kDim>::finishColumn(int j) {
  const Eigen::LLT<Block> pivot(column_[index(j)]);
  if (pivot.info() != Eigen::Success || !column_[index(j)].allFinite()) return false;
  // The inverse of a small triangle once, then plain products.
  Block& inverse = L_.diagonal[index(j)];
  inverse = pivot.matrixL().solve(Block::Identity());
  const Block inverse_transposed = inverse.transpose();
  for (std::size_t b = L_.begin[index(j)]; b < L_.begin[index(j) + 1]; ++b) {
    L_.below[b].noalias() = column_[index(L_.rows[b])].lazyProduct(inverse_transposed);
  }
  used_[index(j)] = L_.begin[index(j)];
  enqueue(j);
  return true;
}

template <int kDim>
void BlockCholesky<kDim>::enqueue(int k) {
  if (used_[index(k)] == L_.begin[index(k) + 1]) return;
  int& first = first_[index(L_.rows[used_[index(k)]])];
  next_[index(k)] = first;
  first = k;
}

template <int kDim>
void BlockCholesky<kDim>::solve(Eigen::VectorXd* b) const {
  using Segment = Eigen::Matrix<double, kDim, 1>;
  for (int j = 0; j < L_.size(); ++j) {
    const Segment x = L_.diagonal[index(j)].lazyProduct(b->segment<kDim>(kDim * j));
    b->segment<kDim>(kDim * j) = x;
    for (std::size_t k = L_.begin[index(j)]; k < L_.begin[index(j) + 1]; ++k) {
      b->segment<kDim>(kDim * L_.rows[k]) -= L_.below[k].lazyProduct(x);
    }
  }
  for (int j = L_.size(); j-- > 0;) {
    Segment x = b->segment<kDim>(kDim * j);
    for (std::size_t k = L_.begin[index(j)]; k < L_.begin[index(j) + 1]; ++k) {
      x -= L_.below[k].transpose().lazyProduct(b->segment<kDim>(kDim * L_.rows[k]));
    }
    b->segment<kDim>(kDim * j) = L_.diagonal[index(j)].transpose().lazyProduct(x);
  }
}

template class BlockCholesky<3>;
template class BlockCholesky<4>;
template class BlockCholesky<6>;

}  // namespace vins::pose_graph
