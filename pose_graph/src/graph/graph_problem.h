#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "pose_graph/graph/block_normal_equations.h"
#include "pose_graph/graph/minimizer.h"
#include "pose_graph/graph/robust_kernel.h"

namespace vins::pose_graph {

/// A graph of states with errors between pairs of them, as a least-squares problem. `Model` has
/// - kDim, State, and State plus(const State&, const Segment&): the manifold;
/// - Edge with from, to (numbers of states) and kernel;
/// - evaluate(edge, from, to, r, J_r_from, J_r_to): the whitened error, and its Jacobians unless
///   null.
/// Robust kernels act by reweighting: H stays positive semidefinite.
template <typename Model>
class GraphProblem : public LeastSquaresProblem {
 public:
  using State = typename Model::State;
  using Edge = typename Model::Edge;
  using Equations = BlockNormalEquations<Model::kDim>;
  using Block = typename Equations::Block;
  using Segment = typename Equations::Segment;

  /// `is_constant`: for each state, whether it stays as it is.
  GraphProblem(std::vector<State> states, const std::vector<bool>& is_constant,
               std::vector<Edge> edges)
      : states_(std::move(states)),
        trial_(states_),
        unknown_(numberUnknowns(is_constant)),
        edges_(withUnknowns(std::move(edges), is_constant)),
        equations_(countUnknowns(is_constant), pairs()) {}

  const std::vector<State>& states() const { return states_; }

  double linearize() override {
    equations_.setZero();
    double cost = 0.0;
    typename Equations::Contribution share;
    Segment r;
    Block J_i, J_j;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      const Edge& edge = edges_[k];
      Model::evaluate(edge, at(states_, edge.from), at(states_, edge.to), &r, &J_i, &J_j);
      const double squared_error = r.squaredNorm();
      const double weight = edge.kernel.weight(squared_error);
      cost += edge.kernel.cost(squared_error);
      const Block JtW_i = weight * J_i.transpose(), JtW_j = weight * J_j.transpose();
      share.H_ii.noalias() = JtW_i * J_i;
      share.H_ij.noalias() = JtW_i * J_j;
      share.H_jj.noalias() = JtW_j * J_j;
      share.g_i.noalias() = JtW_i * r;
      share.g_j.noalias() = JtW_j * r;
      equations_.add(k, share);
    }
    return 0.5 * cost;
  }

  const Eigen::VectorXd& gradient() const override { return equations_.gradient(); }
  Eigen::VectorXd diagonal() const override { return equations_.diagonal(); }
  double curvature(const Eigen::VectorXd& x) const override { return equations_.curvature(x); }

  bool solve(double damping, Eigen::VectorXd* step) override {
    if (!equations_.factorize(damping)) return false;
    *step = -equations_.solve(equations_.gradient());
    return step->allFinite();
  }

  double tryStep(const Eigen::VectorXd& step) override {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (unknown_[i] == Equations::kConstant) continue;
      trial_[i] =
          Model::plus(states_[i], step.template segment<Model::kDim>(Model::kDim * unknown_[i]));
    }
    double cost = 0.0;
    Segment r;
    for (const Edge& edge : edges_) {
      Model::evaluate(edge, at(trial_, edge.from), at(trial_, edge.to), &r, nullptr, nullptr);
      cost += edge.kernel.cost(r.squaredNorm());
    }
    return 0.5 * cost;
  }

  void acceptTrial() override { states_ = trial_; }

 private:
  static const State& at(const std::vector<State>& states, int i) {
    return states[static_cast<std::size_t>(i)];
  }
  static int countUnknowns(const std::vector<bool>& is_constant) {
    int count = 0;
    for (const bool constant : is_constant) count += constant ? 0 : 1;
    return count;
  }
  static std::vector<int> numberUnknowns(const std::vector<bool>& is_constant) {
    std::vector<int> numbers;
    int next = 0;
    for (const bool constant : is_constant) {
      numbers.push_back(constant ? Equations::kConstant : next++);
    }
    return numbers;
  }
  /// Edges between constant states say nothing about the unknown ones.
  static std::vector<Edge> withUnknowns(std::vector<Edge> edges,
                                        const std::vector<bool>& is_constant) {
    std::vector<Edge> kept;
    for (Edge& edge : edges) {
      const bool idle = is_constant[static_cast<std::size_t>(edge.from)] &&
                        is_constant[static_cast<std::size_t>(edge.to)];
      if (!idle) kept.push_back(std::move(edge));
    }
    return kept;
  }
  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> pairs;
    for (const Edge& edge : edges_) {
      pairs.emplace_back(unknown_[static_cast<std::size_t>(edge.from)],
                         unknown_[static_cast<std::size_t>(edge.to)]);
    }
    return pairs;
  }

  std::vector<State> states_, trial_;
  std::vector<int> unknown_;  ///< number of each state's block, or kConstant
  std::vector<Edge> edges_;
  Equations equations_;
};

}  // namespace vins::pose_graph
