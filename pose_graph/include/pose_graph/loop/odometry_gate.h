#pragma once

#include <cstdint>
#include <optional>

#include "pose_graph/graph/keyframe_graph.h"
#include "vins_core/pose.h"

namespace vins::pose_graph {

/// How far odometry is trusted against what two images seem to show: several times its usual drift
/// (0.1 to 1 % of the way), so that poor odometry can still be put right.
struct OdometryGateOptions {
  double position_slack = 1.0;   ///< a loop may differ by this, however short the way [m]
  double position_share = 0.03;  ///< and by this share of the way (loop_max_drift)
  double yaw_slack = 10.0;       ///< [deg]
  double yaw_rate = 0.2;         ///< [deg/m], of the way

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// A loop beside what the graph says of its two keyframes.
struct OdometryComparison {
  double way = 0.0;             ///< between the two, by odometry and loops, the shortest [m]
  double position_error = 0.0;  ///< of the loop against the graph [m]
  double yaw_error = 0.0;       ///< [rad]
  bool is_plausible = true;
};

/// Length of the shortest way between two keyframes along the odometry's path and over loops, which
/// cost nothing [m]: what odometry's drift between them grows with. (E. W. Dijkstra, "A note on two
/// problems in connexion with graphs", 1959.) Nothing where there is none, or one is not known.
std::optional<double> wayBetween(const KeyframeGraph& graph, std::int64_t a, std::int64_t b);

/// Compares a loop with the graph, whose poses have all earlier loops in them. Places that look the
/// same, two corridors of one house, pass every test of images; only the way flown tells them
/// apart. `T_old_query`: query's body in the old one's. Nothing where no way leads from one to the
/// other: a new run may begin anywhere.
std::optional<OdometryComparison> compareWithOdometry(const OdometryGateOptions& options,
                                                      const KeyframeGraph& graph,
                                                      std::int64_t query_id, std::int64_t old_id,
                                                      const Pose& T_old_query);

}  // namespace vins::pose_graph
