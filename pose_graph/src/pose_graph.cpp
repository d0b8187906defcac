#include "pose_graph/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pose_graph/graph/heading.h"
#include "pose_graph/graph/loop_thinning.h"
#include "pose_graph/loop/match_drawing.h"
#include "pose_graph/place/recent_images.h"
#include "vins_core/heading.h"
#include "vins_core/pose_covariance.h"
#include "vins_core/wall_clock.h"

namespace vins::pose_graph {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// `age`: how long ago the old keyframe was [s].
Event loopEvent(Stamp stamp, double age, const LoopVerification& loop, double score) {
  return {stamp,
          Severity::kInfo,
          "loop_found",
          "a place was recognised",
          {{"query", static_cast<double>(loop.query_id)},
           {"old", static_cast<double>(loop.old_id)},
           {"inliers", static_cast<double>(loop.pose_inliers)},
           {"distance_m", loop.distance},
           {"yaw_deg", loop.yaw / kDegree},
           {"score", score},
           {"seconds_ago", age}}};
}

Event gateEvent(Stamp stamp, const LoopVerification& loop, const OdometryComparison& comparison) {
  return {
      stamp,
      Severity::kInfo,
      "loop_against_odometry",
      "two places look the same, but the way flown cannot have led from one to the other; if it "
      "can, the odometry is bad: raise loop_max_drift",
      {{"query", static_cast<double>(loop.query_id)},
       {"old", static_cast<double>(loop.old_id)},
       {"way_m", comparison.way},
       {"off_by_m", comparison.position_error},
       {"off_by_deg", comparison.yaw_error / kDegree}}};
}

/// Times the distance and the angle of a single neighbour.
constexpr double kCrowdReach = 3.0;

bool isNear(const Pose& a, const Pose& b, double distance, double angle) {
  return (a.position - b.position).norm() < distance &&
         a.rotation.angularDistance(b.rotation) < angle;
}

/// Bytes of the graph's tree of keyframes: a vertex, its key and the tree's three links.
std::size_t graphMemory(const KeyframeGraph& graph) {
  constexpr std::size_t kNode = sizeof(KeyframeVertex) + sizeof(std::int64_t) + 4 * sizeof(void*);
  return graph.vertices().size() * kNode + graph.loops().capacity() * sizeof(LoopEdge);
}

}  // namespace

std::string PoseGraphStatistics::describeRejected() const {
  std::size_t sum = 0;
  std::string reasons;
  for (const auto& [status, count] : rejected) {
    sum += count;
    reasons += (reasons.empty() ? " (" : ", ") + std::to_string(count) + " " + toString(status);
  }
  return std::to_string(sum) + " candidates rejected" + (reasons.empty() ? "" : reasons + ")");
}

PoseGraph::PoseGraph(const PoseGraphOptions& options,
                     std::shared_ptr<const camera_model::Camera> camera, const PlaceModel& places)
    : options_(options),
      finder_(std::move(camera), places, options.loops),
      graph_(KeyframeGraph(options.graph)),
      optimizer_(&graph_, options.optimizer, [this](const FourDofResult& result) {
        ++runs_;
        if (result.summary.status == MinimizerStatus::kFailed) ++failures_;
      }) {
  options_.validate();
}

PoseGraphResult PoseGraph::addKeyframe(const Keyframe& keyframe, const cv::Mat& image) {
  PoseGraphResult result;
  if (!addToGraph(keyframe, &result)) return result;
  if (!image.empty() && toSeconds(keyframe.chosen_at - keyframe.stamp) <= kLongestChoice) {
    const LoopFinder::Gate gate = gateFor(keyframe.stamp, &result.events);
    take(keyframe, finder_.addKeyframe(keyframe, image, gate), &result);
  }
  removeRedundant();
  return result;
}

PoseGraphResult PoseGraph::addDescribed(const Keyframe& keyframe, DescribedView described) {
  PoseGraphResult result;
  if (!addToGraph(keyframe, &result)) return result;
  const LoopFinder::Gate gate = gateFor(keyframe.stamp, &result.events);
  take(keyframe, finder_.addDescribed(keyframe, std::move(described), gate), &result);
  removeRedundant();
  return result;
}

bool PoseGraph::addToGraph(const Keyframe& keyframe, PoseGraphResult* result) {
  reportFailures(keyframe.stamp, &result->events);
  result->optimize_seconds = optimizeIfWaiting();
  result->is_kept = isWorthKeeping(keyframe);
  if (!result->is_kept) {
    ++counts_.skipped;
    return false;
  }
  graph_.use([&](KeyframeGraph& graph) {
    graph.addKeyframe(keyframe.id, keyframe.sequence, keyframe.stamp, keyframe.T_wb,
                      keyframe.world);
  });
  newest_sequence_ = keyframe.sequence;
  left_to_skip_ = options_.skip_count;
  return true;
}

bool PoseGraph::isWorthKeeping(const Keyframe& keyframe) {
  if (newest_sequence_ != keyframe.sequence) return true;
  if (left_to_skip_ > 0) {
    --left_to_skip_;
    return false;
  }
  return graph_.use([&](const KeyframeGraph& graph) { return showsSomethingNew(keyframe, graph); });
}

bool PoseGraph::showsSomethingNew(const Keyframe& keyframe, const KeyframeGraph& graph) const {
  // In the map: an odometry that drifts while the body stands still shows nothing new.
  const Pose T_mb = graph.drift(keyframe.sequence).value_or(Pose()) * keyframe.T_wb;
  const std::vector<std::int64_t>& ids = graph.keyframesOf(keyframe.sequence);
  const auto reach = static_cast<std::size_t>(options_.skip_neighbours);
  const double distance = options_.skip_distance, angle = options_.skip_angle * kDegree;
  int around = 0;
  for (std::size_t i = ids.size() - std::min(reach, ids.size()); i < ids.size(); ++i) {
    const Pose& other = graph.vertices().at(ids[i]).T_mb;
    if (isNear(other, T_mb, distance, angle)) return false;
    around += isNear(other, T_mb, kCrowdReach * distance, kCrowdReach * angle) ? 1 : 0;
  }
  return around < options_.skip_crowd;
}

LoopFinder::Gate PoseGraph::gateFor(Stamp stamp, std::vector<Event>* events) {
  return [this, stamp, events](const LoopVerification& loop) {
    return agreesWithOdometry(stamp, loop, events);
  };
}

void PoseGraph::take(const Keyframe& keyframe, LoopSearch search, PoseGraphResult* result) {
  result->search = std::move(search);
  const LoopVerification* accepted = result->search.accepted();
  for (const CheckedCandidate& checked : result->search.checked) {
    const LoopStatus status = checked.verification.status;
    if (status != LoopStatus::kAccepted) ++counts_.rejected[status];
  }
  if (accepted != nullptr) {
    addFound(keyframe, *accepted, result->search.checked.back().score, result);
  }
}

bool PoseGraph::agreesWithOdometry(Stamp stamp, const LoopVerification& loop,
                                   std::vector<Event>* events) {
  const auto comparison = graph_.use([&](const KeyframeGraph& graph) {
    return compareWithOdometry(options_.gate, graph, loop.query_id, loop.old_id, loop.T_old_query);
  });
  if (!comparison || comparison->is_plausible) return true;
  constexpr double kQuiet = 5.0;  // seconds: along a corridor every keyframe would tell of it
  const bool is_news = !last_gate_event_ || toSeconds(stamp - *last_gate_event_) >= kQuiet ||
                       stamp < *last_gate_event_;
  if (is_news) {
    events->push_back(gateEvent(stamp, loop, *comparison));
    last_gate_event_ = stamp;
  }
  return false;
}

void PoseGraph::addFound(const Keyframe& keyframe, const LoopVerification& loop, double score,
                         PoseGraphResult* result) {
  ++counts_.found;
  result->match = matchOf(keyframe, loop);
  const Stamp old_stamp = graph_.use(
      [&](const KeyframeGraph& graph) { return graph.vertices().at(loop.old_id).stamp; });
  result->events.push_back(
      loopEvent(keyframe.stamp, toSeconds(keyframe.stamp - old_stamp), loop, score));
  const LoopOutcome outcome =
      graph_.use([&](KeyframeGraph& graph) { return graph.addLoopEdge(edgeOf(*result->match)); });
  noteOutcome(outcome, keyframe.stamp, &result->events);
  waits_for_refinement_ = options_.refines_in_window;
  if (!waits_for_refinement_) result->optimize_seconds += optimize();
}

LoopMatch PoseGraph::matchOf(const Keyframe& keyframe, const LoopVerification& loop) {
  LoopMatch match;
  match.query_id = loop.query_id;
  match.old_id = loop.old_id;
  match.query_stamp = keyframe.stamp;
  match.T_old_query = loop.T_old_query;
  match.T_bc_old = finder_.view(loop.old_id)->T_bc;
  match.features = loop.features;
  // Roll and pitch of the old keyframe are what gravity has told then; its yaw and its place in
  // this odometry's world are known by the loop alone.
  const Eigen::Quaterniond R_w_old = graph_.use(
      [&](const KeyframeGraph& graph) { return graph.vertices().at(loop.old_id).T_wb.rotation; });
  match.T_wb_old = keyframe.T_wb * loop.T_old_query.inverse();
  const double yaw = yawOf(match.T_wb_old.rotation * R_w_old.conjugate());
  match.T_wb_old.rotation = yawRotation(yaw) * R_w_old;
  return match;
}

LoopEdge PoseGraph::edgeOf(const LoopMatch& match) const {
  LoopEdge edge;
  edge.query_id = match.query_id;
  edge.old_id = match.old_id;
  edge.query_stamp = match.query_stamp;
  edge.T_old_query = match.T_old_query;
  const double position = options_.found_position_sigma;
  const double rotation = options_.found_rotation_sigma * kDegree;
  edge.covariance.diagonal().head<3>().setConstant(position * position);
  edge.covariance.diagonal().tail<3>().setConstant(rotation * rotation);
  edge.inliers = static_cast<int>(match.features.size());
  return edge;
}

void PoseGraph::noteOutcome(LoopOutcome outcome, Stamp stamp, std::vector<Event>* events) {
  if (outcome != LoopOutcome::kJoined) return;
  events->push_back({stamp,
                     Severity::kInfo,
                     "sequence_joined",
                     "a loop has joined this run to an earlier one",
                     {{"sequence", static_cast<double>(newest_sequence_.value_or(0))}}});
}

double PoseGraph::optimizeIfWaiting() { return waits_for_refinement_ ? optimize() : 0.0; }

double PoseGraph::optimize() {
  waits_for_refinement_ = false;
  if (options_.threaded) {
    optimizer_.request();
    return 0.0;
  }
  WallClock clock;
  optimizer_.solveNow();
  return clock.lap();
}

void PoseGraph::reportFailures(Stamp stamp, std::vector<Event>* events) {
  const std::size_t failures = failures_;
  if (failures == failures_told_) return;
  events->push_back({stamp,
                     Severity::kWarning,
                     "optimization_failed",
                     "the pose graph could not be optimized; it stays as it was",
                     {{"failures", static_cast<double>(failures)}}});
  failures_told_ = failures;
}

void PoseGraph::removeRedundant() {
  const std::vector<std::int64_t> ids = graph_.use([&](KeyframeGraph& graph) {
    for (const LoopEdge& loop : redundantLoops(graph, options_.thinning)) {
      graph.removeLoopEdge(loop.query_id, loop.old_id);
    }
    const std::vector<std::int64_t> redundant = redundantKeyframes(graph, options_.thinning);
    for (const std::int64_t id : redundant) graph.removeKeyframe(id);
    return redundant;
  });
  for (const std::int64_t id : ids) finder_.remove(id);
  counts_.removed += ids.size();
}

bool PoseGraph::update(const KeyframePoseUpdate& update) {
  return graph_.use(
      [&](KeyframeGraph& graph) { return graph.updateOdometry(update.keyframe_id, update.T_wb); });
}

LoopEdgeResult PoseGraph::addLoopEdge(const LoopEdge& edge) {
  LoopEdgeResult result;
  result.outcome = graph_.use([&](KeyframeGraph& graph) { return graph.addLoopEdge(edge); });
  noteOutcome(result.outcome, edge.query_stamp, &result.events);
  const bool is_in =
      result.outcome != LoopOutcome::kUnknownKeyframe && result.outcome != LoopOutcome::kUnusable;
  if (!is_in) return result;
  ++counts_.refined;
  result.optimize_seconds = optimize();
  return result;
}

void PoseGraph::finish() {
  const bool has_loops =
      graph_.use([](const KeyframeGraph& graph) { return !graph.loops().empty(); });
  if (has_loops) optimizer_.solveNow();
}

std::optional<Pose> PoseGraph::drift(SequenceNumber sequence) {
  return graph_.use([&](const KeyframeGraph& graph) { return graph.drift(sequence); });
}

MapFromOdom PoseGraph::locate(SequenceNumber sequence, const Pose& T_wb) {
  if (located_sequence_ && sequence > *located_sequence_) placeNewWorld(sequence, T_wb);
  const std::optional<MapFromOdom> map_from_odom =
      graph_.use([&](const KeyframeGraph& graph) { return graph.mapFromOdom(sequence); });
  if (!map_from_odom) return {};
  located_sequence_ = sequence;
  last_T_mb_ = map_from_odom->pose * T_wb;
  return *map_from_odom;
}

void PoseGraph::placeNewWorld(SequenceNumber sequence, const Pose& T_wb) {
  // Between two recordings, or while the estimator was not there.
  constexpr double kUnknownPosition = 10.0;  // deviation per axis [m]
  constexpr double kUnknownYaw = 1.8;        // that of an angle of which nothing is known [rad]
  se3::Matrix6d of_body = se3::Matrix6d::Zero();
  of_body.diagonal().head<3>().setConstant(kUnknownPosition * kUnknownPosition);
  of_body(5, 5) = kUnknownYaw * kUnknownYaw;
  const Pose T_mw = driftOf(last_T_mb_, T_wb);
  const se3::Matrix6d covariance = covarianceByPoint(T_mw.rotation * T_wb.position, of_body);
  graph_.use([&](KeyframeGraph& graph) {
    if (graph.beginsWorld(sequence)) graph.placeSequence(sequence, {T_mw, covariance});
  });
}

std::vector<SequencePath> PoseGraph::paths() {
  return graph_.use([](const KeyframeGraph& graph) {
    std::vector<SequencePath> paths;
    for (const SequenceNumber sequence : graph.sequences()) {
      SequencePath path{sequence, graph.inMap(sequence), {}};
      for (const std::int64_t id : graph.keyframesOf(sequence)) {
        path.keyframes.push_back(graph.vertices().at(id));
      }
      paths.push_back(std::move(path));
    }
    return paths;
  });
}

std::vector<LoopEdge> PoseGraph::loops() {
  return graph_.use([](const KeyframeGraph& graph) { return graph.loops(); });
}

PoseGraphStatistics PoseGraph::statistics() {
  PoseGraphStatistics statistics = counts_;
  graph_.use([&](const KeyframeGraph& graph) {
    statistics.keyframes = graph.vertices().size();
    statistics.sequences = graph.sequences().size();
    statistics.loops = graph.loops().size();
    statistics.memory = finder_.memory() + graphMemory(graph);
  });
  statistics.optimizations = runs_;
  return statistics;
}

cv::Mat PoseGraph::draw(const CheckedCandidate& checked, const cv::Mat& query_image,
                        const cv::Mat& old_image) const {
  const KeyframeView* query = finder_.view(checked.verification.query_id);
  const KeyframeView* old = finder_.view(checked.verification.old_id);
  if (query == nullptr || old == nullptr) return {};
  return drawMatches(query_image, old_image, *query, *old, checked.verification, checked.score);
}

}  // namespace vins::pose_graph
