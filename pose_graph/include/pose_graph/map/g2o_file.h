#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "pose_graph/graph/relative_pose_graph.h"

namespace vins::pose_graph {

/// A graph in g2o's text format, with what of the file is not understood.
///
/// Tags: VERTEX_SE3:QUAT id x y z qx qy qz qw; EDGE_SE3:QUAT i j x y z qx qy qz qw and the upper
/// triangle of a 6x6 information matrix, position first; VERTEX_SE2 id x y theta; EDGE_SE2 i j x y
/// theta and the upper triangle of a 3x3 matrix; FIX id ... [m], [rad].
///
/// g2o's own solver takes the vector part of the error's quaternion, about half the rotation
/// vector, as error of rotation; here, as in GTSAM, the matrix belongs to the rotation vector
/// [rad].
struct G2oFile {
  RelativePoseGraph graph;
  std::vector<std::string> other_lines;  ///< with other tags: kept, and written at the end
  std::vector<std::string> warnings;     ///< one for each unknown tag, with its first line
};

/// Reads a graph. Empty lines and those that begin with '#' are passed over. Throws InputError with
/// `name` and the line where a value is missing, superfluous or not finite, a quaternion is not of
/// unit length (to 1e-2; then it is normalized), a pose is there twice, an edge or FIX names a pose
/// that the file does not have, an information matrix is not positive semidefinite, or SE(2) and
/// SE(3) are mixed; or where there is no pose at all.
G2oFile readG2o(std::istream& in, const std::string& name);

/// The same from the file at `path`.
G2oFile readG2oFile(const std::string& path);

/// The graph as text that readG2o() reads back without loss.
std::string toG2o(const G2oFile& file);

/// Writes it aside, then renames. Throws InputError where it cannot be written.
void writeG2oFile(const std::string& path, const G2oFile& file);

}  // namespace vins::pose_graph
