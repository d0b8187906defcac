#include "pose_graph/graph/four_dof.h"

#include <algorithm>
#include <set>

#include "graph_problem.h"
#include "pose_graph/graph/heading.h"

namespace vins::pose_graph {
namespace {

using State = FourDofModel::State;
using Edge = FourDofModel::Edge;

/// Keyframes of the components that have loops, as numbered states.
class StateNumbers {
 public:
  explicit StateNumbers(const KeyframeGraph& graph) {
    std::set<std::int64_t> loop_ends;
    for (const LoopEdge& loop : graph.loops()) loop_ends.insert({loop.query_id, loop.old_id});
    std::set<SequenceNumber> begun;  // components whose oldest loop end has been passed
    // From old sequences to new ones: a component's oldest sequence comes first.
    for (const SequenceNumber sequence : graph.sequences()) {
      const SequenceNumber component = graph.component(sequence);
      for (const std::int64_t id : graph.keyframesOf(sequence)) {
        add(graph.vertices().at(id), begun.count(component) == 0);
        if (loop_ends.count(id) > 0) begun.insert(component);
      }
    }
  }

  int numberOf(std::int64_t id) const { return numbers_.at(id); }
  const std::vector<State>& states() const { return states_; }
  const std::vector<bool>& constant() const { return is_constant_; }
  const std::map<std::int64_t, int>& numbers() const { return numbers_; }

 private:
  void add(const KeyframeVertex& vertex, bool is_constant) {
    numbers_[vertex.id] = static_cast<int>(states_.size());
    const double yaw = yawOf(vertex.T_mb.rotation * vertex.T_wb.rotation.conjugate());
    states_.push_back({vertex.T_mb.position, yaw});
    is_constant_.push_back(is_constant);
  }

  std::map<std::int64_t, int> numbers_;
  std::vector<State> states_;
  std::vector<bool> is_constant_;
};

std::vector<Edge> makeEdges(const KeyframeGraph& graph, const StateNumbers& numbers,
                            const RobustKernel& loop_kernel) {
  std::vector<Edge> edges;
  for (const HeadingEdge& edge : graph.edges()) {
    edges.push_back({numbers.numberOf(edge.from), numbers.numberOf(edge.to), edge.position,
                     edge.yaw, 1.0 / edge.position_sigma, 1.0 / edge.yaw_sigma,
                     edge.is_loop ? loop_kernel : RobustKernel()});
  }
  return edges;
}

GraphCorrection makeCorrection(const KeyframeGraph& graph, const StateNumbers& numbers,
                               const std::vector<State>& states) {
  GraphCorrection correction;
  for (const auto& [id, number] : numbers.numbers()) {
    const auto index = static_cast<std::size_t>(number);
    if (numbers.constant()[index]) continue;
    const Eigen::Quaterniond R_mw = yawRotation(states[index].yaw);
    const Eigen::Vector3d p_mw =
        states[index].position - R_mw * graph.vertices().at(id).T_wb.position;
    correction.T_mw.emplace(id, Pose(R_mw, p_mw));
  }
  for (const SequenceNumber sequence : graph.sequences()) {
    correction.components[sequence] = graph.component(sequence);
  }
  return correction;
}

}  // namespace

State FourDofModel::plus(const State& state, const Segment& step) {
  return {state.position + step.head<3>(), state.yaw + step[3]};
}

void FourDofModel::evaluate(const Edge& edge, const State& from, const State& to, Segment* r,
                            Block* J_r_from, Block* J_r_to) {
  const double c = std::cos(from.yaw), s = std::sin(from.yaw);
  const Eigen::Vector3d d = to.position - from.position;
  const Eigen::Vector3d d_i(c * d.x() + s * d.y(), c * d.y() - s * d.x(), d.z());
  r->head<3>() = edge.position_weight * (d_i - edge.position);
  (*r)[3] = edge.yaw_weight * wrapAngle(to.yaw - from.yaw - edge.yaw);
  if (J_r_from == nullptr || J_r_to == nullptr) return;
  Eigen::Matrix3d R_im;
  R_im << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  J_r_to->setZero();
  J_r_to->topLeftCorner<3, 3>() = edge.position_weight * R_im;
  (*J_r_to)(3, 3) = edge.yaw_weight;
  *J_r_from = -*J_r_to;
  // d/dyaw of R_z(yaw)^T d is -e_z x (R_z^T d).
  J_r_from->topRightCorner<3, 1>() = edge.position_weight * Eigen::Vector3d(d_i.y(), -d_i.x(), 0.0);
}

void FourDofOptions::validate() const {
  loop_kernel.validate();
  minimizer.validate();
}

FourDofResult optimizeFourDof(const KeyframeGraph& graph, const FourDofOptions& options) {
  options.validate();
  const StateNumbers numbers(graph);
  GraphProblem<FourDofModel> problem(numbers.states(), numbers.constant(),
                                     makeEdges(graph, numbers, options.loop_kernel));
  FourDofResult result;
  result.summary = minimize(&problem, options.minimizer);
  if (result.summary.status == MinimizerStatus::kFailed) return result;
  result.correction = makeCorrection(graph, numbers, problem.states());
  return result;
}

}  // namespace vins::pose_graph
