#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "pose_graph/graph/keyframe_graph.h"
#include "pose_graph/graph/map_from_odom.h"
#include "pose_graph/graph/optimizer_thread.h"
#include "pose_graph/loop/loop_finder.h"
#include "pose_graph/map/map_file.h"
#include "pose_graph/map/picture_store.h"
#include "pose_graph/pose_graph_options.h"
#include "vins_core/event.h"
#include "vins_core/keyframe.h"
#include "vins_core/loop_match.h"

namespace vins::pose_graph {

/// What came of a keyframe.
struct PoseGraphResult {
  bool is_kept = false;            ///< false: too near to the last ones, left out
  std::optional<LoopMatch> match;  ///< a verified loop, for the estimator
  LoopSearch search;               ///< what was compared on the way, for drawing
  std::vector<Event> events;
  double optimize_seconds = 0.0;  ///< in the caller; for statistics only
};

/// What came of a refined loop.
struct LoopEdgeResult {
  LoopOutcome outcome = LoopOutcome::kUnknownKeyframe;
  std::vector<Event> events;
  double optimize_seconds = 0.0;  ///< in the caller; for statistics only
};

/// Keyframes of a sequence, old ones first, with their poses in odometry and map.
struct SequencePath {
  SequenceNumber sequence = 0;
  bool in_map = false;  ///< false: no loop has joined it to the map yet
  std::vector<KeyframeVertex> keyframes;
};

/// What a map has brought.
struct LoadedMap {
  std::size_t keyframes = 0;
  std::size_t sequences = 0;
  std::size_t loops = 0;
  std::size_t without_view = 0;  ///< keyframes whose places cannot be told again
  bool same_vocabulary = true;   ///< false: the words were found anew, by this vocabulary

  /// A line for people.
  std::string describe() const;
};

/// Counts since the start.
struct PoseGraphStatistics {
  std::size_t keyframes = 0;  ///< in the graph
  std::size_t skipped = 0;    ///< left out: too near to others
  std::size_t removed = 0;    ///< to keep the graph bounded
  std::size_t sequences = 0;
  std::size_t loops = 0;                       ///< edges in the graph
  std::size_t found = 0;                       ///< verified loops
  std::size_t refined = 0;                     ///< of these, measured again by the estimator
  std::map<LoopStatus, std::size_t> rejected;  ///< candidates that were refused, by the reason
  std::size_t optimizations = 0;
  std::size_t memory = 0;  ///< of views, index and graph, about [bytes]

  /// "114 candidates rejected (90 few matches, 24 few pose inliers)".
  std::string describeRejected() const;
};

/// The third stage: keyframes in, verified loops and the corrected path out. (T. Qin, P. Li, S.
/// Shen, "VINS-Mono", T-RO 2018, sections VII and VIII.)
///
/// For use by one thread; the optimization has its own, unless told otherwise. A run without that
/// thread gives the same on every run.
class PoseGraph {
 public:
  /// Throws InputError for bad options.
  PoseGraph(const PoseGraphOptions& options, std::shared_ptr<const camera_model::Camera> camera,
            const PlaceModel& places);

  /// A keyframe and its image, CV_8UC1, or none: then the place is not remembered, nor is that of
  /// a keyframe that was chosen long after its image (see kLongestChoice). Ids must rise.
  /// Throws InputError where the id is known, the stamp does not rise within the sequence, or the
  /// image is not the camera's.
  PoseGraphResult addKeyframe(const Keyframe& keyframe, const cv::Mat& image);

  /// The same with a view that has been made already, as ViewDescriber makes it.
  PoseGraphResult addDescribed(const Keyframe& keyframe, DescribedView described);

  /// The odometry's last word on a keyframe. False where it is not in the graph.
  bool update(const KeyframePoseUpdate& update);

  /// A loop as the estimator has refined it: in place of the verification's.
  LoopEdgeResult addLoopEdge(const LoopEdge& edge);

  /// Waits until no optimization is under way or asked for.
  void waitUntilIdle() { optimizer_.waitUntilIdle(); }

  /// The input has ended: the graph is optimized once more with all that is known.
  void finish();

  /// Writes all keyframes and loops as they are now to one file, with their pictures where a store
  /// is given; see MapWriter. Sequences that no loop has joined stay apart. The number of keyframes
  /// is returned. Throws InputError naming the file where it cannot be written, or where there is
  /// no keyframe yet.
  std::size_t save(const std::string& path, const PictureStore* pictures = nullptr);

  /// Adds a map, whose places are looked for from the next keyframe on. Its keyframes and sequences
  /// get negative numbers, below all that are there: its frame is that of the map from now on, and
  /// a sequence of this run joins it by its first loop with it; until then it stands alone. Throws
  /// InputError as readMap() does, or where the map's descriptors are of another pattern; all is
  /// then as it was.
  LoadedMap load(const std::string& path, PictureStore* pictures = nullptr);

  /// T_map_odom of a sequence as known now, yaw and translation only; nothing where it has no
  /// keyframe.
  std::optional<Pose> drift(SequenceNumber sequence);

  /// Where the odometry's world stands in the map, for an odometry pose T_wb of a sequence: to be
  /// asked for each odometry in its order, for the map's odometry does not jump where it can be
  /// avoided. A sequence in the same world as an earlier one begins with the correction of that.
  /// The first of a new world (a restarted recording or estimator) begins where the body was last
  /// seen in the map; how far it has moved since is not known, as the covariance says. Both hold
  /// until a loop joins the sequence. Identity where the sequence has no keyframe yet.
  MapFromOdom locate(SequenceNumber sequence, const Pose& T_wb);

  /// A copy of the keyframes by sequence, from old to new.
  std::vector<SequencePath> paths();

  /// A copy of the loops.
  std::vector<LoopEdge> loops();

  PoseGraphStatistics statistics();

  /// A picture of a comparison that addKeyframe() told of, for people: see drawMatches(). Empty
  /// where a view has been forgotten since.
  cv::Mat draw(const CheckedCandidate& checked, const cv::Mat& query_image,
               const cv::Mat& old_image) const;

 private:
  bool isWorthKeeping(const Keyframe& keyframe);
  void placeNewWorld(SequenceNumber sequence, const Pose& T_wb);
  bool showsSomethingNew(const Keyframe& keyframe, const KeyframeGraph& graph) const;
  bool addToGraph(const Keyframe& keyframe, PoseGraphResult* result);
  void take(const Keyframe& keyframe, LoopSearch search, PoseGraphResult* result);
  LoopFinder::Gate gateFor(Stamp stamp, std::vector<Event>* events);
  /// False where the way flown contradicts a loop that images have verified; an event tells of it.
  bool agreesWithOdometry(Stamp stamp, const LoopVerification& loop, std::vector<Event>* events);
  void addFound(const Keyframe& keyframe, const LoopVerification& loop, double score,
                PoseGraphResult* result);
  LoopMatch matchOf(const Keyframe& keyframe, const LoopVerification& loop);
  LoopEdge edgeOf(const LoopMatch& match) const;
  void noteOutcome(LoopOutcome outcome, Stamp stamp, std::vector<Event>* events);
  double optimize();
  double optimizeIfWaiting();
  void reportFailures(Stamp stamp, std::vector<Event>* events);
  void removeRedundant();

  PoseGraphOptions options_;
  LoopFinder finder_;
  SharedKeyframeGraph graph_;
  PoseGraphStatistics counts_;
  std::optional<SequenceNumber> newest_sequence_;
  std::optional<SequenceNumber> located_sequence_;  ///< of the newest odometry
  Pose last_T_mb_;                                  ///< of the newest odometry, in the map
  int left_to_skip_ = 0;
  bool waits_for_refinement_ = false;     ///< a found loop is in the graph and not optimized yet
  std::optional<Stamp> last_gate_event_;  ///< [ns]
  std::atomic<std::size_t> runs_{0};
  std::atomic<std::size_t> failures_{0};
  std::size_t failures_told_ = 0;
  OptimizerThread optimizer_;  ///< last: it works on the others
};

}  // namespace vins::pose_graph
