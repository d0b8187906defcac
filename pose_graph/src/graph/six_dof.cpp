#include "pose_graph/graph/six_dof.h"

#include <string>

#include <Eigen/Eigenvalues>

#include "graph_problem.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using se3::Matrix6d;
using se3::Vector6d;

/// Element of SE(3)'s tangent vectors that is number k of the model's.
template <int kDim>
constexpr Eigen::Index element(Eigen::Index k) {
  return kDim == 3 && k == 2 ? 5 : k;
}

template <int kDim>
Eigen::Matrix<double, kDim, 1> reduced(const Vector6d& xi) {
  if constexpr (kDim == 6) return xi;
  Eigen::Matrix<double, kDim, 1> y;
  for (int k = 0; k < kDim; ++k) y[k] = xi[element<kDim>(k)];
  return y;
}

template <int kDim>
Eigen::Matrix<double, kDim, kDim> reduced(const Matrix6d& A) {
  if constexpr (kDim == 6) return A;
  Eigen::Matrix<double, kDim, kDim> B;
  for (int k = 0; k < kDim; ++k) {
    for (int l = 0; l < kDim; ++l) B(k, l) = A(element<kDim>(k), element<kDim>(l));
  }
  return B;
}

constexpr double kRounding = 1e-9;  // of eigenvalues, against the largest

/// L with L^T L = A, by the eigenvalues: A may be singular.
template <typename Block>
Block squareRoot(const Block& A) {
  const Eigen::SelfAdjointEigenSolver<Block> solver(A);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

template <int kDim>
std::vector<typename RelativePoseModel<kDim>::Edge> makeEdges(const RelativePoseGraph& graph,
                                                              const GraphTopology& topology,
                                                              const RobustKernel& kernel) {
  std::vector<typename RelativePoseModel<kDim>::Edge> edges;
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const RelativePoseEdge& edge = graph.edges[k];
    const auto information = reduced<kDim>(edge.information);
    if (!isPositiveSemidefinite(information)) {
      throw InputError("pose graph: edge from pose " + std::to_string(edge.from) + " to " +
                       std::to_string(edge.to) +
                       ": found an information matrix with a negative eigenvalue; allowed: "
                       "positive semidefinite ones");
    }
    edges.push_back(
        {topology.from[k], topology.to[k], edge.T_ij.inverse(), squareRoot(information), kernel});
  }
  return edges;
}

template <int kDim>
MinimizerSummary optimize(RelativePoseGraph* graph, const SixDofOptions& options) {
  const GraphTopology topology(*graph);
  std::vector<Pose> poses;
  for (const GraphPose& pose : graph->poses) poses.push_back(pose.T_wi);
  GraphProblem<RelativePoseModel<kDim>> problem(std::move(poses), topology.anchors(*graph),
                                                makeEdges<kDim>(*graph, topology, options.kernel));
  const MinimizerSummary summary = minimize(&problem, options.minimizer);
  for (std::size_t i = 0; i < graph->poses.size(); ++i) graph->poses[i].T_wi = problem.states()[i];
  return summary;
}

}  // namespace

template <int kTangent>
Pose RelativePoseModel<kTangent>::plus(const Pose& state, const Segment& step) {
  Vector6d xi = Vector6d::Zero();
  for (int k = 0; k < kDim; ++k) xi[element<kDim>(k)] = step[k];
  return state * se3::exp(xi);
}

template <int kTangent>
void RelativePoseModel<kTangent>::evaluate(const Edge& edge, const Pose& from, const Pose& to,
                                           Segment* r, Block* J_r_from, Block* J_r_to) {
  const Pose T_ij = from.inverse() * to;
  const Vector6d error = se3::log(edge.T_ji * T_ij);
  *r = edge.square_root * reduced<kDim>(error);
  if (J_r_from == nullptr || J_r_to == nullptr) return;
  *J_r_to = edge.square_root * reduced<kDim>(se3::rightJacobianInverse(error));
  *J_r_from = -*J_r_to * reduced<kDim>(se3::adjoint(T_ij.inverse()));
}

template struct RelativePoseModel<3>;
template struct RelativePoseModel<6>;

bool isPositiveSemidefinite(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = solver.eigenvalues();
  return values.minCoeff() >= -kRounding * values.cwiseAbs().maxCoeff();
}

void SixDofOptions::validate() const {
  kernel.validate();
  minimizer.validate();
}

MinimizerSummary optimizeSixDof(RelativePoseGraph* graph, const SixDofOptions& options) {
  options.validate();
  return graph->planar ? optimize<3>(graph, options) : optimize<6>(graph, options);
}

}  // namespace vins::pose_graph
