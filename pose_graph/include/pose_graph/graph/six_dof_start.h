#pragma once

#include "pose_graph/graph/relative_pose_graph.h"

namespace vins::pose_graph {

/// Starts for optimizeSixDof(), made of the edges alone: fixed poses (or the first of a connected
/// part) stay, all others are placed anew. All throw InputError as GraphTopology does.

/// Edges between neighbours in the list of poses, one after the other, as an odometry gives them.
/// Throws InputError naming the pose where there is no such edge.
void startFromOdometry(RelativePoseGraph* graph);

/// Edges of a spanning tree of the fewest edges from the anchor (breadth first): errors add up over
/// short chains.
void startFromSpanningTree(RelativePoseGraph* graph);

/// Chordal initialization (L. Carlone, R. Tron, K. Daniilidis, F. Dellaert, "Initialization
/// techniques for 3D SLAM", ICRA 2015, section III-B): the rotations minimize the sum of
/// w |R_i R_ij - R_j|^2 as matrices, a linear problem, and are taken to the nearest rotations; then
/// the positions minimize the sum of w |p_j - p_i - R_i t_ij|^2. The weights w are the edges' mean
/// information of rotation and of position. False, and the spanning tree's start, where the linear
/// problem has no solution.
bool startFromChordalRotations(RelativePoseGraph* graph);

}  // namespace vins::pose_graph
