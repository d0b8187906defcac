#pragma once

#include <ostream>
#include <string>

#include "pose_graph/graph/four_dof.h"
#include "pose_graph/graph/keyframe_graph.h"
#include "pose_graph/graph/thinning.h"
#include "pose_graph/loop/loop_finder.h"
#include "pose_graph/loop/odometry_gate.h"
#include "pose_graph/place/place_model.h"
#include "vins_core/parameters.h"

namespace vins::pose_graph {

/// What PoseGraph goes by.
struct PoseGraphOptions {
  LoopFinderOptions loops;
  OdometryGateOptions gate;
  KeyframeGraphOptions graph;
  FourDofOptions optimizer;
  ThinningOptions thinning;

  /// A keyframe nearer than this to one of the last ones in the map, and turned less than
  /// `skip_angle` from it, is left out (skip_dis): 0 keeps all [m].
  double skip_distance = 0.05;
  double skip_angle = 3.0;    ///< [deg]
  int skip_crowd = 12;        ///< nor is one left in among so many within three times of both
  int skip_neighbours = 100;  ///< the last keyframes, which are compared with
  int skip_count = 0;         ///< keyframes left out after each one that is taken (skip_cnt)

  /// Of a loop as the verification has measured it, until the estimator has refined it. The
  /// matches' own noise is small: 25 of them, off by 2 px, give 0.05 degrees and, 5 m away, 4 mm.
  /// What they share is more: their depths come from one window, whose scale is known to a percent
  /// (5 cm of 5 m) and whose tilt and yaw move with them by some tenths of a degree.
  double found_position_sigma = 0.05;  ///< [m]
  double found_rotation_sigma = 0.5;   ///< [deg]

  /// A loop that is found goes to the estimator and comes back refined, as a rule at once: the
  /// optimization waits for that, until the next keyframe at most. fast_relocalization in a
  /// configuration file, where it is on by default.
  bool refines_in_window = false;

  /// Optimizes on a thread of its own; false: in the caller, so that every run is the same.
  bool threaded = true;

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const PoseGraphOptions& options);

/// What a configuration file says of loop closing, in VINS-Mono's names where it has them.
struct PoseGraphConfiguration {
  bool is_on = true;       ///< loop_closure
  PlaceModelFiles files;   ///< vocabulary_file, brief_pattern_file
  bool loads_map = false;  ///< load_previous_pose_graph: map_file is loaded
  std::string map_file;    ///< pose_graph.map in pose_graph_save_path; "" where that is not given
  bool saves_images = false;  ///< save_image: keyframes' images are kept in the map
  PoseGraphOptions options;
};

/// Reads loop_closure, skip_dis, skip_cnt, load_previous_pose_graph, pose_graph_save_path,
/// fast_relocalization, save_image, vocabulary_file, brief_pattern_file, max_keyframes,
/// min_loop_inliers, loop_max_drift, position_drift and yaw_drift. All have defaults; files are
/// seen from the configuration's folder. Throws InputError naming file, key, what was found and
/// what is allowed. A map is loaded only from a folder that is given.
PoseGraphConfiguration readPoseGraphConfiguration(const Parameters& parameters);

}  // namespace vins::pose_graph
