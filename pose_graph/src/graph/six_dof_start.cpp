#include "pose_graph/graph/six_dof_start.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pose_graph/graph/block_normal_equations.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Equations = BlockNormalEquations<3>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// T_ab of an edge's two ends, seen from the end `a`.
Pose relativePose(const RelativePoseGraph& graph, const GraphTopology& topology, int edge, int a) {
  const Pose& T_ij = graph.edges[index(edge)].T_ij;
  return topology.from[index(edge)] == a ? T_ij : T_ij.inverse();
}

/// Linear least squares for a vector x_i per pose: sum of w |x_j - A_ij x_i - b_ij|^2, several
/// right-hand sides one after the other. Poses that are anchors keep their value.
class VectorGraph {
 public:
  VectorGraph(const GraphTopology& topology, const std::vector<bool>& is_anchor)
      : topology_(topology), unknown_(is_anchor.size(), Equations::kConstant) {
    for (std::size_t i = 0; i < is_anchor.size(); ++i) {
      if (!is_anchor[i]) unknown_[i] = count_++;
    }
    std::vector<std::pair<int, int>> pairs;
    for (std::size_t k = 0; k < topology.from.size(); ++k) {
      pairs.emplace_back(unknown_[index(topology.from[k])], unknown_[index(topology.to[k])]);
    }
    equations_ = std::make_unique<Equations>(count_, std::move(pairs));
  }

  void setMatrices(std::vector<Matrix3d> A, std::vector<double> weights) {
    A_ = std::move(A);
    weights_ = std::move(weights);
    is_factorized_ = false;
  }

  /// Replaces the vectors of poses that are no anchors by the best. False: there is none.
  bool solve(const std::vector<Vector3d>& b, std::vector<Vector3d>* x) {
    equations_->setZero();
    for (std::size_t k = 0; k < A_.size(); ++k) {
      const Vector3d& x_i = (*x)[index(topology_.from[k])];
      const Vector3d r = (*x)[index(topology_.to[k])] - A_[k] * x_i - b[k];
      const Matrix3d AtW = weights_[k] * A_[k].transpose();
      equations_->add(
          k, {AtW * A_[k], -AtW, weights_[k] * Matrix3d::Identity(), -AtW * r, weights_[k] * r});
    }
    if (!is_factorized_ && !equations_->factorize()) return false;
    is_factorized_ = true;
    const Eigen::VectorXd step = equations_->solve(-equations_->gradient());
    for (std::size_t i = 0; i < unknown_.size(); ++i) {
      if (unknown_[i] != Equations::kConstant) (*x)[i] += step.segment<3>(3 * unknown_[i]);
    }
    return step.allFinite();
  }

 private:
  const GraphTopology& topology_;
  std::vector<int> unknown_;
  int count_ = 0;
  std::unique_ptr<Equations> equations_;
  std::vector<Matrix3d> A_;
  std::vector<double> weights_;
  bool is_factorized_ = false;
};

/// Rows of the rotation matrices are independent of each other: R_j^T e_k = R_ij^T (R_i^T e_k).
bool solveRotations(VectorGraph* equations, RelativePoseGraph* graph) {
  std::vector<Matrix3d> A;
  std::vector<double> weights;
  for (const RelativePoseEdge& edge : graph->edges) {
    A.push_back(edge.T_ij.rotation.conjugate().toRotationMatrix());
    const auto information = edge.information.diagonal().tail<3>();
    weights.push_back(graph->planar ? information[2] : information.mean());
  }
  equations->setMatrices(std::move(A), std::move(weights));
  const std::vector<Vector3d> zero(graph->edges.size(), Vector3d::Zero());
  std::vector<Eigen::Matrix4d> T(graph->poses.size(), Eigen::Matrix4d::Identity());
  for (int k = 0; k < 3; ++k) {
    std::vector<Vector3d> rows;
    for (const GraphPose& pose : graph->poses) {
      rows.emplace_back(pose.T_wi.rotation.toRotationMatrix().row(k));
    }
    if (!equations->solve(zero, &rows)) return false;
    for (std::size_t i = 0; i < T.size(); ++i) T[i].block<1, 3>(k, 0) = rows[i].transpose();
  }
  for (std::size_t i = 0; i < T.size(); ++i) {
    graph->poses[i].T_wi.rotation = poseFromMatrix(T[i]).rotation;
  }
  return true;
}

bool solvePositions(VectorGraph* equations, const GraphTopology& topology,
                    RelativePoseGraph* graph) {
  std::vector<Vector3d> b, positions;
  std::vector<double> weights;
  for (std::size_t k = 0; k < graph->edges.size(); ++k) {
    const RelativePoseEdge& edge = graph->edges[k];
    b.push_back(graph->poses[index(topology.from[k])].T_wi.rotation * edge.T_ij.position);
    const auto information = edge.information.diagonal().head<3>();
    weights.push_back(graph->planar ? information.head<2>().mean() : information.mean());
  }
  for (const GraphPose& pose : graph->poses) positions.push_back(pose.T_wi.position);
  equations->setMatrices(std::vector<Matrix3d>(graph->edges.size(), Matrix3d::Identity()),
                         std::move(weights));
  if (!equations->solve(b, &positions)) return false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    graph->poses[i].T_wi.position = positions[i];
  }
  return true;
}

}  // namespace

void startFromOdometry(RelativePoseGraph* graph) {
  const GraphTopology topology(*graph);
  const std::vector<bool> is_anchor = topology.anchors(*graph);
  for (std::size_t i = 1; i < graph->poses.size(); ++i) {
    if (is_anchor[i]) continue;
    const auto before = static_cast<int>(i) - 1;
    const GraphTopology::Link* found = nullptr;
    for (const GraphTopology::Link& link : topology.links[i]) {
      if (found == nullptr && link.other == before) found = &link;
    }
    if (found == nullptr) {
      throw InputError("pose graph: found no edge from pose " +
                       std::to_string(graph->poses[i - 1].id) + " to the next in the list, " +
                       std::to_string(graph->poses[i].id) +
                       "; a start from the spanning tree needs none");
    }
    graph->poses[i].T_wi =
        graph->poses[i - 1].T_wi * relativePose(*graph, topology, found->edge, before);
  }
}

void startFromSpanningTree(RelativePoseGraph* graph) {
  const GraphTopology topology(*graph);
  std::vector<bool> placed = topology.anchors(*graph);
  std::vector<int> queue;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (placed[i]) queue.push_back(static_cast<int>(i));
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const int i = queue[next];
    for (const GraphTopology::Link& link : topology.links[index(i)]) {
      if (placed[index(link.other)]) continue;
      placed[index(link.other)] = true;
      graph->poses[index(link.other)].T_wi =
          graph->poses[index(i)].T_wi * relativePose(*graph, topology, link.edge, i);
      queue.push_back(link.other);
    }
  }
}

bool startFromChordalRotations(RelativePoseGraph* graph) {
  const GraphTopology topology(*graph);
  VectorGraph equations(topology, topology.anchors(*graph));
  RelativePoseGraph result = *graph;
  if (!solveRotations(&equations, &result) || !solvePositions(&equations, topology, &result)) {
    startFromSpanningTree(graph);
    return false;
  }
  *graph = std::move(result);
  return true;
}

}  // namespace vins::pose_graph
