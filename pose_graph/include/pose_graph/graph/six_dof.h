#pragma once

#include <array>

#include <Eigen/Core>

#include "pose_graph/graph/minimizer.h"
#include "pose_graph/graph/relative_pose_graph.h"
#include "pose_graph/graph/robust_kernel.h"
#include "vins_core/pose.h"

namespace vins::pose_graph {

/// Error of a relative pose, r = L log(T_ij^-1 T_i^-1 T_j) with L^T L the information (G. Grisetti,
/// R. Kuemmerle, C. Stachniss, W. Burgard, "A tutorial on graph-based SLAM", 2010), perturbed on
/// the right: T [+] d = T exp(d). With e the logarithm and T_ji = T_j^-1 T_i, J_r_j = L J_r^-1(e)
/// and J_r_i = -L J_r^-1(e) Ad(T_ji) (Barfoot 2017, section 7.3).
///
/// SE(2) is the subgroup of SE(3) that keeps z, with the same exponential: its tangent vectors are
/// the elements 0, 1 and 5 of SE(3)'s, and the Jacobians those rows and columns. kDim is 6 or 3.
template <int kTangent>
struct RelativePoseModel {
  static constexpr int kDim = kTangent;
  using State = Pose;
  using Block = Eigen::Matrix<double, kDim, kDim>;
  using Segment = Eigen::Matrix<double, kDim, 1>;  ///< position [m], rotation [rad]

  struct Edge {
    int from = 0, to = 0;                   ///< numbers of states
    Pose T_ji;                              ///< inverse of the measured T_ij
    Block square_root = Block::Identity();  ///< L
    RobustKernel kernel;
  };

  static State plus(const State& state, const Segment& step);

  /// The whitened error and, unless null, its Jacobians by the two states.
  static void evaluate(const Edge& edge, const State& from, const State& to, Segment* r,
                       Block* J_r_from, Block* J_r_to);
};

extern template struct RelativePoseModel<3>;
extern template struct RelativePoseModel<6>;

/// What optimizeSixDof() goes by.
struct SixDofOptions {
  RobustKernel kernel;  ///< of all edges
  MinimizerOptions minimizer;

  /// Throws InputError naming the option that is out of range.
  void validate() const;
};

/// Finds the poses that fit all edges best. Fixed poses stay; in a connected part without any, the
/// first pose stays. Throws InputError naming the edge where ids are wrong (GraphTopology) or an
/// information matrix is not positive semidefinite.
MinimizerSummary optimizeSixDof(RelativePoseGraph* graph, const SixDofOptions& options);

/// Whether a symmetric matrix is positive semidefinite, to rounding.
bool isPositiveSemidefinite(const Eigen::MatrixXd& matrix);

}  // namespace vins::pose_graph
