#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pose_graph/graph/map_from_odom.h"
#include "vins_core/loop_match.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins::pose_graph {

/// Counts runs of the odometry from 0 on. Negative: a run of a loaded map, older than all of these.
using SequenceNumber = std::int64_t;

/// A keyframe's place in the graph.
struct KeyframeVertex {
  std::int64_t id = 0;          ///< negative: of a loaded map
  SequenceNumber sequence = 0;  ///< run of the odometry that it belongs to
  Stamp stamp = 0;              ///< [ns]
  Pose T_wb;                    ///< body in its own sequence's odometry world
  Pose T_mb;                    ///< body in the map; roll and pitch are those of T_wb
  double travelled = 0.0;       ///< by the odometry since the sequence's first keyframe [m]
};

/// Relative pose of two keyframes in four degrees of freedom. Each keyframe carries a heading
/// frame: at its body, with the axes of its odometry's world, so z is up; in the map it has turned
/// by the yaw between T_wb and T_mb. An edge says where the heading frame of `to` stands in that
/// of `from`. (VINS-Mono's edges, up to the choice of the heading frame: a body's own yaw is
/// undefined when its x axis is vertical, as it often is in EuRoC.)
struct HeadingEdge {
  std::int64_t from = 0;  ///< the older keyframe
  std::int64_t to = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0.0;                                    ///< [rad]
  double position_sigma = 1.0;                         ///< standard deviation of each axis [m]
  double yaw_sigma = 1.0;                              ///< [rad]
  bool is_loop = false;
};

/// Weights of the edges: odometry drifts as a random walk in time, so that a long step, left by a
/// removed keyframe, is as uncertain as the steps that it replaces. A keyframe's edges to its
/// predecessors tell the same story many times over; their variances are greater by their number.
struct KeyframeGraphOptions {
  int predecessors = 5;  ///< of the same sequence that a keyframe has an edge to
  /// Farther back in time only the very last one is: where keyframes have left, edges to more would
  /// repeat each other, and the time of an optimization grows with the square of their number.
  double predecessor_seconds = 3.0;
  double position_drift = 0.01;  ///< of the odometry [m/sqrt(s)]
  double yaw_drift = 0.001;      ///< of the odometry [rad/sqrt(s)]
  /// Of a loop, beside its own covariance, which knows nothing of the calibration's errors: of a
  /// focal length to 0.3 %, seen over 5 m, and of distortion to a pixel at 460 px/rad.
  double loop_position_sigma = 0.015;  ///< [m]
  double loop_yaw_sigma = 0.002;       ///< [rad]

  /// Throws InputError naming the option that is out of range.
  void validate() const;
};

/// What became of a loop edge.
enum class LoopOutcome {
  kAdded,            ///< between keyframes that had a common frame already
  kJoined,           ///< the same, and two sequences have a common frame from now on
  kReplaced,         ///< in place of an earlier measurement between the same two keyframes
  kUnknownKeyframe,  ///< not added: one of its ends is not in the graph
  kUnusable,         ///< not added: its ends are one keyframe, or it holds no finite numbers
};

/// Where an optimization wants keyframes to be.
struct GraphCorrection {
  /// By keyframe: map <- its odometry's world, yaw and translation only.
  std::map<std::int64_t, Pose> T_mw;
  /// The component that each sequence belonged to then.
  std::map<SequenceNumber, SequenceNumber> components;
};

/// Keyframes, the odometry's edges between them and the loops (T. Qin, P. Li, S. Shen, "VINS-Mono",
/// T-RO 2018, section VII). Sequences that a loop has joined form a component with one frame: that
/// of its oldest sequence. The component of the very first sequence is the map.
///
/// Sequential edges are not stored: they are what the odometry poses say. So an updated pose
/// remakes its edges, and across a removed keyframe the edges to it are composed, by themselves.
class KeyframeGraph {
 public:
  explicit KeyframeGraph(const KeyframeGraphOptions& options = {});

  /// A graph as it was stored: map poses are taken as they are, sequences joined as the loops say.
  /// Throws InputError as addKeyframe() does, or where a loop's end is missing.
  static KeyframeGraph restore(const KeyframeGraphOptions& options,
                               const std::vector<KeyframeVertex>& vertices,
                               const std::vector<LoopEdge>& loops);

  /// Adds what restore() takes to this graph, whose ids and sequences must be others. Throws as
  /// restore() does; the graph is then as it was.
  void addStored(const std::vector<KeyframeVertex>& vertices, const std::vector<LoopEdge>& loops);

  /// Appends a keyframe to its sequence; its map pose follows from its sequence's drift. A new
  /// sequence whose odometry's `world` (Keyframe::world) an earlier one had too begins with the
  /// drift of that one; nullopt is a world of its own. Throws InputError where the id is there
  /// already, the stamp does not rise in the sequence, or the pose holds no finite numbers.
  void addKeyframe(std::int64_t id, SequenceNumber sequence, Stamp stamp, const Pose& T_wb,
                   std::optional<std::uint32_t> world = std::nullopt);

  /// The odometry's last word on a keyframe: its map pose is carried along. False: not there.
  bool updateOdometry(std::int64_t id, const Pose& T_wb);

  /// Adds a loop, or puts it in place of the one that has the same two ends. Where it is the first
  /// between two components, the younger one is moved as a whole by the transform with yaw only
  /// that fulfils the loop; the older one stays.
  LoopOutcome addLoopEdge(const LoopEdge& edge);

  /// Takes the loop between two keyframes out. Runs that it has joined stay joined. False: not
  /// there.
  bool removeLoopEdge(std::int64_t query_id, std::int64_t old_id);

  /// Takes a keyframe out. Its loops are handed to its nearest neighbour in the sequence, along the
  /// odometry, unless that has a loop with the same sequence already, which says the same: so loops
  /// do not pile up. Without neighbour they go too. False: not there.
  bool removeKeyframe(std::int64_t id);

  /// Moves keyframes as an optimization of an earlier state of this graph wants it. Keyframes added
  /// since are moved as the newest optimized one of their sequence. Removed keyframes, and
  /// sequences that have joined another component since, are passed over.
  void apply(const GraphCorrection& correction);

  /// map <- odometry world of a sequence, at its newest keyframe, yaw and translation only: what
  /// "map -> odom" is made of. Nothing for an unknown sequence.
  std::optional<Pose> drift(SequenceNumber sequence) const;

  /// The same as drift() with its covariance: that of the loop by which the sequence joined its
  /// component, or of the sequence that it carries on. What later optimizations gain is not
  /// counted.
  std::optional<MapFromOdom> mapFromOdom(SequenceNumber sequence) const;

  /// Whether a sequence has begun in a world that no earlier sequence had.
  bool beginsWorld(SequenceNumber sequence) const;

  /// Moves a sequence, and what has joined it, to another place. Does nothing and returns false
  /// where it is unknown, or has joined an older one, whose frame it shares.
  bool placeSequence(SequenceNumber sequence, const MapFromOdom& place);

  /// The sequence whose frame this one shares: itself, or an older one. Throws std::out_of_range
  /// for an unknown sequence.
  SequenceNumber component(SequenceNumber sequence) const {
    return sequences_.at(sequence).component;
  }

  /// Whether a sequence belongs to the map.
  bool inMap(SequenceNumber sequence) const;

  /// All keyframes, by id.
  const std::map<std::int64_t, KeyframeVertex>& vertices() const { return vertices_; }

  /// Ids of a sequence's keyframes from old to new; empty for an unknown sequence.
  const std::vector<std::int64_t>& keyframesOf(SequenceNumber sequence) const;

  /// Sequences from old to new.
  std::vector<SequenceNumber> sequences() const;

  /// Loops as they were measured.
  const std::vector<LoopEdge>& loops() const { return loops_; }

  /// Sequential edges by sequence, then loop edges in the order in which they were added.
  std::vector<HeadingEdge> edges() const;

 private:
  struct Sequence {
    SequenceNumber component = 0;
    std::vector<std::int64_t> ids;                     ///< from old to new
    Pose T_mw;                                         ///< at the newest keyframe there has been
    se3::Matrix6d covariance = se3::Matrix6d::Zero();  ///< of T_mw, see MapFromOdom
    std::optional<std::uint32_t> world;                ///< of its odometry
  };

  void insert(KeyframeVertex vertex);
  const Sequence* newestOf(std::optional<std::uint32_t> world) const;
  std::vector<LoopEdge>::iterator findLoop(std::int64_t query_id, std::int64_t old_id);
  void joinComponents(SequenceNumber older, SequenceNumber younger);
  void moveComponent(SequenceNumber component, const MapFromOdom& T_new_old,
                     SequenceNumber measured);
  se3::Matrix6d covarianceOfCorrection(const KeyframeVertex& fixed, const KeyframeVertex& moved,
                                       const Pose& T_new_old, const LoopEdge& edge) const;
  void noteDrift(Sequence* sequence) const;
  Pose correctionOf(const LoopEdge& edge) const;
  std::optional<std::int64_t> nearestNeighbour(const KeyframeVertex& vertex) const;
  bool hasLoopWith(const KeyframeVertex& vertex, const LoopEdge& like,
                   const KeyframeVertex& from) const;
  void handOverLoops(const KeyframeVertex& from, std::optional<std::int64_t> to);
  void applyTo(Sequence* sequence, const GraphCorrection& correction);
  std::size_t predecessorsOf(const std::vector<std::int64_t>& ids, std::size_t to) const;
  HeadingEdge sequentialEdge(const KeyframeVertex& from, const KeyframeVertex& to,
                             std::size_t repetitions) const;
  HeadingEdge loopEdge(const LoopEdge& loop) const;

  KeyframeGraphOptions options_;
  std::map<std::int64_t, KeyframeVertex> vertices_;
  std::map<SequenceNumber, Sequence> sequences_;
  std::vector<LoopEdge> loops_;
};

}  // namespace vins::pose_graph
