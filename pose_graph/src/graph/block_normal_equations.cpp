#include "pose_graph/graph/block_normal_equations.h"

#include <algorithm>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace vins::pose_graph {

template <int kDim>
BlockNormalEquations<kDim>::BlockNormalEquations(int unknowns,
                                                 std::vector<std::pair<int, int>> edges)
    : unknowns_(unknowns), edges_(std::move(edges)) {
  orderVertices();
  makePattern();
  gradient_.setZero(kDim * unknowns_);
  cholesky_.emplace(H_);
}

template <int kDim>
void BlockNormalEquations<kDim>::orderVertices() {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < unknowns_; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [i, j] : edges_) {
    if (i == kConstant || j == kConstant) continue;
    entries.emplace_back(i, j, 1.0);
    entries.emplace_back(j, i, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(unknowns_, unknowns_);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  position_.resize(static_cast<std::size_t>(unknowns_));
  for (int k = 0; k < unknowns_; ++k) position_[static_cast<std::size_t>(order.indices()[k])] = k;
}

template <int kDim>
void BlockNormalEquations<kDim>::makePattern() {
  const auto ends = [this](const std::pair<int, int>& edge) {
    const int i = position_[std::size_t(edge.first)], j = position_[std::size_t(edge.second)];
    return std::make_pair(std::min(i, j), std::max(i, j));
  };
  const auto is_block = [](const auto& e) { return e.first != kConstant && e.second != kConstant; };
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(unknowns_));  // by column
  for (const auto& edge : edges_) {
    if (is_block(edge)) rows[std::size_t(ends(edge).first)].push_back(ends(edge).second);
  }
  H_.begin.push_back(0);
  for (auto& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    H_.rows.insert(H_.rows.end(), column.begin(), column.end());
    H_.begin.push_back(H_.rows.size());
  }
  H_.diagonal.resize(static_cast<std::size_t>(unknowns_));
  H_.below.resize(H_.rows.size());
  for (const auto& edge : edges_) {
    edge_places_.push_back(0);
    if (!is_block(edge)) continue;
    const auto& column = rows[std::size_t(ends(edge).first)];
    const auto found = std::lower_bound(column.begin(), column.end(), ends(edge).second);
    edge_places_.back() =
        H_.begin[std::size_t(ends(edge).first)] + static_cast<std::size_t>(found - column.begin());
  }
}

template <int kDim>
void BlockNormalEquations<kDim>::setZero() {
  std::fill(H_.diagonal.begin(), H_.diagonal.end(), Block::Zero());
  std::fill(H_.below.begin(), H_.below.end(), Block::Zero());
  gradient_.setZero();
}

template <int kDim>
void BlockNormalEquations<kDim>::add(std::size_t edge, const Contribution& share) {
  const auto [i, j] = edges_[edge];
  if (i != kConstant) {
    H_.diagonal[std::size_t(position_[std::size_t(i)])] += share.H_ii;
    gradient_.template segment<kDim>(kDim * i) += share.g_i;
  }
  if (j != kConstant) {
    H_.diagonal[std::size_t(position_[std::size_t(j)])] += share.H_jj;
    gradient_.template segment<kDim>(kDim * j) += share.g_j;
  }
  if (i == kConstant || j == kConstant) return;
  Block& block = H_.below[edge_places_[edge]];
  if (position_[std::size_t(i)] > position_[std::size_t(j)]) {
    block += share.H_ij;
  } else {
    block += share.H_ij.transpose();
  }
}

template <int kDim>
Eigen::VectorXd BlockNormalEquations<kDim>::diagonal() const {
  Eigen::VectorXd values(kDim * unknowns_);
  for (int i = 0; i < unknowns_; ++i) {
    values.segment<kDim>(kDim * i) = H_.diagonal[std::size_t(position_[std::size_t(i)])].diagonal();
  }
  return values;
}

template <int kDim>
Eigen::VectorXd BlockNormalEquations<kDim>::ordered(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  for (int i = 0; i < unknowns_; ++i) {
    y.segment<kDim>(kDim * position_[std::size_t(i)]) = x.segment<kDim>(kDim * i);
  }
  return y;
}

template <int kDim>
double BlockNormalEquations<kDim>::curvature(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd y = ordered(x);
  double sum = 0.0;
  for (int j = 0; j < unknowns_; ++j) {
    const Segment y_j = y.segment<kDim>(kDim * j);
    Segment Hy = H_.diagonal[std::size_t(j)] * y_j;
    for (std::size_t b = H_.begin[std::size_t(j)]; b < H_.begin[std::size_t(j) + 1]; ++b) {
      Hy += 2.0 * (H_.below[b].transpose() * y.segment<kDim>(kDim * H_.rows[b]));
    }
    sum += y_j.dot(Hy);
  }
  return sum;
}

template <int kDim>
bool BlockNormalEquations<kDim>::factorize(double damping) {
  return cholesky_->factorize(H_, damping);
}

template <int kDim>
Eigen::VectorXd BlockNormalEquations<kDim>::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd y = ordered(b);
  cholesky_->solve(&y);
  Eigen::VectorXd x(y.size());
  for (int i = 0; i < unknowns_; ++i) {
    x.segment<kDim>(kDim * i) = y.segment<kDim>(kDim * position_[std::size_t(i)]);
  }
  return x;
}

template class BlockNormalEquations<3>;
template class BlockNormalEquations<4>;
template class BlockNormalEquations<6>;

}  // namespace vins::pose_graph
