#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"

namespace vins::pose_graph {

/// A pose to be found.
struct GraphPose {
  std::int64_t id = 0;
  Pose T_wi;
  bool fixed = false;
};

/// A measured relative pose. In a planar graph only x, y and the turn about z count: the rows and
/// columns 0, 1 and 5 of `information`.
struct RelativePoseEdge {
  std::int64_t from = 0;  ///< i
  std::int64_t to = 0;    ///< j
  Pose T_ij;
  /// Inverse covariance of the error log(T_ij^-1 T_i^-1 T_j): position [1/m^2], rotation [1/rad^2].
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
};

/// A general pose graph, of SE(3) or, planar, of SE(2): all its poses lie in z = 0 and turn about
/// z.
struct RelativePoseGraph {
  bool planar = false;
  std::vector<GraphPose> poses;
  std::vector<RelativePoseEdge> edges;
};

/// Edges as pairs of numbers in `graph.poses`, and what hangs together. Throws InputError where an
/// edge names a pose that is not there, or joins one to itself, or an id is there twice.
struct GraphTopology {
  explicit GraphTopology(const RelativePoseGraph& graph);

  /// A pose of each connected part that holds it in place: its fixed ones, or else its first.
  std::vector<bool> anchors(const RelativePoseGraph& graph) const;

  struct Link {
    int edge = 0;
    int other = 0;  ///< the pose at the other end
  };
  std::vector<int> from, to;             ///< by edge
  std::vector<std::vector<Link>> links;  ///< by pose, in the order of the edges
};

}  // namespace vins::pose_graph
