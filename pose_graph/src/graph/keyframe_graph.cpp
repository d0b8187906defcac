#include "pose_graph/graph/keyframe_graph.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pose_graph/graph/heading.h"
#include "vins_core/input_error.h"
#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

bool isFinite(const Pose& pose) {
  return pose.rotation.coeffs().allFinite() && pose.position.allFinite();
}

double durationBetween(const KeyframeVertex& a, const KeyframeVertex& b) {
  // Stamps of a sequence rise; the floor keeps weights finite for rates beyond any camera's.
  return std::max(1e-3, std::abs(toSeconds(b.stamp - a.stamp)));
}

}  // namespace

void KeyframeGraphOptions::validate() const {
  constexpr Range kSigma{1e-6, 1e3};
  requireWithin("keyframe graph", "predecessors", predecessors, {1, 100});
  requireWithin("keyframe graph", "predecessor_seconds", predecessor_seconds, {0, 1e6});
  requireWithin("keyframe graph", "position_drift", position_drift, kSigma);
  requireWithin("keyframe graph", "yaw_drift", yaw_drift, kSigma);
  requireWithin("keyframe graph", "loop_position_sigma", loop_position_sigma, kSigma);
  requireWithin("keyframe graph", "loop_yaw_sigma", loop_yaw_sigma, kSigma);
}

KeyframeGraph::KeyframeGraph(const KeyframeGraphOptions& options) : options_(options) {
  options_.validate();
}

KeyframeGraph KeyframeGraph::restore(const KeyframeGraphOptions& options,
                                     const std::vector<KeyframeVertex>& vertices,
                                     const std::vector<LoopEdge>& loops) {
  KeyframeGraph graph(options);
  graph.addStored(vertices, loops);
  return graph;
}

void KeyframeGraph::addStored(const std::vector<KeyframeVertex>& vertices,
                              const std::vector<LoopEdge>& loops) {
  KeyframeGraph graph(*this);
  for (const KeyframeVertex& vertex : vertices) graph.insert(vertex);
  for (const LoopEdge& loop : loops) {
    const auto query = graph.vertices_.find(loop.query_id), old = graph.vertices_.find(loop.old_id);
    if (query == graph.vertices_.end() || old == graph.vertices_.end()) {
      throw InputError("loop from keyframe " + std::to_string(loop.query_id) + " to " +
                       std::to_string(loop.old_id) + ": found an end that is no keyframe");
    }
    const SequenceNumber of_query = graph.component(query->second.sequence);
    const SequenceNumber of_old = graph.component(old->second.sequence);
    graph.joinComponents(std::min(of_query, of_old), std::max(of_query, of_old));
    graph.loops_.push_back(loop);
  }
  *this = std::move(graph);
}

void KeyframeGraph::insert(KeyframeVertex vertex) {
  const std::string name = "keyframe " + std::to_string(vertex.id);
  if (!isFinite(vertex.T_wb) || !isFinite(vertex.T_mb)) {
    throw InputError(name + ": found a pose with numbers that are not finite");
  }
  const auto known = sequences_.find(vertex.sequence);
  if (known != sequences_.end() && !known->second.ids.empty()) {
    const KeyframeVertex& last = vertices_.at(known->second.ids.back());
    if (vertex.stamp <= last.stamp) {
      throw InputError(name + ": found stamp " + std::to_string(vertex.stamp) +
                       " in a sequence that has reached " + std::to_string(last.stamp) +
                       "; allowed: later ones, or a new sequence");
    }
    vertex.travelled = last.travelled + (vertex.T_wb.position - last.T_wb.position).norm();
  }
  if (!vertices_.emplace(vertex.id, vertex).second) {
    throw InputError(name + ": is in the graph already");
  }
  Sequence& sequence = sequences_[vertex.sequence];
  if (known == sequences_.end()) sequence.component = vertex.sequence;
  sequence.ids.push_back(vertex.id);
  noteDrift(&sequence);
}

void KeyframeGraph::addKeyframe(std::int64_t id, SequenceNumber sequence, Stamp stamp,
                                const Pose& T_wb, std::optional<std::uint32_t> world) {
  const bool is_new = sequences_.count(sequence) == 0;
  MapFromOdom begin;
  if (const Sequence* carried = is_new ? newestOf(world) : nullptr) {
    begin = {carried->T_mw, carried->covariance};
  }
  insert({id, sequence, stamp, T_wb, drift(sequence).value_or(begin.pose) * T_wb, 0.0});
  if (!is_new) return;
  sequences_.at(sequence).world = world;
  sequences_.at(sequence).covariance = begin.covariance;
}

bool KeyframeGraph::updateOdometry(std::int64_t id, const Pose& T_wb) {
  const auto found = vertices_.find(id);
  if (found == vertices_.end() || !isFinite(T_wb)) return false;
  KeyframeVertex& vertex = found->second;
  const Pose T_mw = driftOf(vertex.T_mb, vertex.T_wb);
  vertex.T_wb = T_wb;
  vertex.T_mb = T_mw * T_wb;
  return true;
}

std::vector<LoopEdge>::iterator KeyframeGraph::findLoop(std::int64_t query_id,
                                                        std::int64_t old_id) {
  return std::find_if(loops_.begin(), loops_.end(), [&](const LoopEdge& loop) {
    return loop.query_id == query_id && loop.old_id == old_id;
  });
}

LoopOutcome KeyframeGraph::addLoopEdge(const LoopEdge& edge) {
  const auto query = vertices_.find(edge.query_id), old = vertices_.find(edge.old_id);
  if (query == vertices_.end() || old == vertices_.end()) return LoopOutcome::kUnknownKeyframe;
  if (edge.query_id == edge.old_id || !isFinite(edge.T_old_query) || !edge.covariance.allFinite()) {
    return LoopOutcome::kUnusable;
  }
  const auto known = findLoop(edge.query_id, edge.old_id);
  if (known != loops_.end()) {
    *known = edge;
    return LoopOutcome::kReplaced;
  }
  loops_.push_back(edge);
  const SequenceNumber of_query = component(query->second.sequence);
  const SequenceNumber of_old = component(old->second.sequence);
  if (of_query == of_old) return LoopOutcome::kAdded;
  const Pose T_new_old = correctionOf(edge);
  if (of_old < of_query) {
    const auto covariance = covarianceOfCorrection(old->second, query->second, T_new_old, edge);
    moveComponent(of_query, {T_new_old, covariance}, query->second.sequence);
  } else {
    const Pose T_old_new = T_new_old.inverse();
    const auto covariance = covarianceOfCorrection(query->second, old->second, T_old_new, edge);
    moveComponent(of_old, {T_old_new, covariance}, old->second.sequence);
  }
  joinComponents(std::min(of_query, of_old), std::max(of_query, of_old));
  return LoopOutcome::kJoined;
}

void KeyframeGraph::noteDrift(Sequence* sequence) const {
  if (sequence->ids.empty()) return;
  const KeyframeVertex& newest = vertices_.at(sequence->ids.back());
  sequence->T_mw = driftOf(newest.T_mb, newest.T_wb);
}

std::optional<std::int64_t> KeyframeGraph::nearestNeighbour(const KeyframeVertex& vertex) const {
  const std::vector<std::int64_t>& ids = keyframesOf(vertex.sequence);
  const auto here = std::find(ids.begin(), ids.end(), vertex.id);
  std::optional<std::int64_t> nearest;
  if (here != ids.begin()) nearest = *(here - 1);
  if (here + 1 == ids.end()) return nearest;
  const bool later_is_nearer = !nearest || durationBetween(vertex, vertices_.at(*(here + 1))) <
                                               durationBetween(vertices_.at(*nearest), vertex);
  return later_is_nearer ? *(here + 1) : nearest;
}

bool KeyframeGraph::hasLoopWith(const KeyframeVertex& vertex, const LoopEdge& like,
                                const KeyframeVertex& from) const {
  const auto otherEnd = [](const LoopEdge& loop, std::int64_t id) {
    return loop.query_id == id ? loop.old_id : loop.query_id;
  };
  const SequenceNumber wanted = vertices_.at(otherEnd(like, from.id)).sequence;
  return std::any_of(loops_.begin(), loops_.end(), [&](const LoopEdge& loop) {
    if (loop.query_id != vertex.id && loop.old_id != vertex.id) return false;
    const std::int64_t other = otherEnd(loop, vertex.id);
    return other != from.id && vertices_.at(other).sequence == wanted;
  });
}

void KeyframeGraph::handOverLoops(const KeyframeVertex& from, std::optional<std::int64_t> to) {
  const auto ends_here = [&from](const LoopEdge& loop) {
    return loop.query_id == from.id || loop.old_id == from.id;
  };
  if (to) {
    const KeyframeVertex& heir = vertices_.at(*to);
    const double duration = durationBetween(from, heir);
    const double position_variance = options_.position_drift * options_.position_drift * duration;
    const double yaw_variance = options_.yaw_drift * options_.yaw_drift * duration;
    for (LoopEdge& loop : loops_) {
      if (!ends_here(loop) || hasLoopWith(heir, loop, from)) continue;
      if (loop.query_id == from.id) {
        loop.T_old_query = loop.T_old_query * (from.T_wb.inverse() * heir.T_wb);
        loop.query_id = heir.id;
        loop.query_stamp = heir.stamp;
      } else {
        loop.T_old_query = heir.T_wb.inverse() * from.T_wb * loop.T_old_query;
        loop.old_id = heir.id;
      }
      loop.covariance.diagonal().head<3>().array() += position_variance;
      loop.covariance.diagonal().tail<3>().array() += yaw_variance;
    }
  }
  const auto useless = [&](const LoopEdge& loop) {
    return ends_here(loop) || loop.query_id == loop.old_id;
  };
  loops_.erase(std::remove_if(loops_.begin(), loops_.end(), useless), loops_.end());
}

bool KeyframeGraph::removeLoopEdge(std::int64_t query_id, std::int64_t old_id) {
  const auto found = findLoop(query_id, old_id);
  if (found == loops_.end()) return false;
  loops_.erase(found);
  return true;
}

bool KeyframeGraph::removeKeyframe(std::int64_t id) {
  const auto found = vertices_.find(id);
  if (found == vertices_.end()) return false;
  const KeyframeVertex vertex = found->second;
  handOverLoops(vertex, nearestNeighbour(vertex));
  std::vector<std::int64_t>& ids = sequences_.at(vertex.sequence).ids;
  ids.erase(std::find(ids.begin(), ids.end(), id));
  vertices_.erase(found);
  return true;
}

void KeyframeGraph::apply(const GraphCorrection& correction) {
  for (auto& [number, sequence] : sequences_) {
    const auto then = correction.components.find(number);
    const bool comparable =
        then != correction.components.end() && then->second == sequence.component;
    if (comparable) applyTo(&sequence, correction);
  }
}

void KeyframeGraph::applyTo(Sequence* sequence, const GraphCorrection& correction) {
  std::optional<Pose> T_new_old;  // of the newest optimized keyframe so far
  for (const std::int64_t id : sequence->ids) {
    KeyframeVertex& vertex = vertices_.at(id);
    const auto wanted = correction.T_mw.find(id);
    if (wanted != correction.T_mw.end()) {
      T_new_old = wanted->second * driftOf(vertex.T_mb, vertex.T_wb).inverse();
      vertex.T_mb = wanted->second * vertex.T_wb;
    } else if (T_new_old) {
      vertex.T_mb = *T_new_old * vertex.T_mb;
    }
  }
  noteDrift(sequence);
}

std::optional<Pose> KeyframeGraph::drift(SequenceNumber sequence) const {
  const auto found = sequences_.find(sequence);
  if (found == sequences_.end()) return std::nullopt;
  return found->second.T_mw;
}

bool KeyframeGraph::inMap(SequenceNumber sequence) const {
  const auto found = sequences_.find(sequence);
  return found != sequences_.end() && found->second.component == sequences_.begin()->first;
}

const std::vector<std::int64_t>& KeyframeGraph::keyframesOf(SequenceNumber sequence) const {
  static const std::vector<std::int64_t> kNone;
  const auto found = sequences_.find(sequence);
  return found == sequences_.end() ? kNone : found->second.ids;
}

std::vector<SequenceNumber> KeyframeGraph::sequences() const {
  std::vector<SequenceNumber> numbers;
  for (const auto& item : sequences_) numbers.push_back(item.first);
  return numbers;
}

std::size_t KeyframeGraph::predecessorsOf(const std::vector<std::int64_t>& ids,
                                          std::size_t to) const {
  const std::size_t most = std::min(to, static_cast<std::size_t>(options_.predecessors));
  std::size_t count = std::min<std::size_t>(most, 1);
  while (count < most && durationBetween(vertices_.at(ids[to - count - 1]),
                                         vertices_.at(ids[to])) <= options_.predecessor_seconds) {
    ++count;
  }
  return count;
}

HeadingEdge KeyframeGraph::sequentialEdge(const KeyframeVertex& from, const KeyframeVertex& to,
                                          std::size_t repetitions) const {
  // A step of the odometry is part of edges of every span, and what the edges of one span say of
  // it, those of the others repeat: each is given its share.
  const double root = std::sqrt(static_cast<double>(repetitions) * durationBetween(from, to));
  return {from.id,
          to.id,
          to.T_wb.position - from.T_wb.position,
          0.0,  // by the heading frames' definition: both have the odometry world's axes
          options_.position_drift * root,
          options_.yaw_drift * root,
          false};
}

HeadingEdge KeyframeGraph::loopEdge(const LoopEdge& loop) const {
  const Eigen::Quaterniond& R_w_old = vertices_.at(loop.old_id).T_wb.rotation;
  const Eigen::Quaterniond& R_w_query = vertices_.at(loop.query_id).T_wb.rotation;
  const Eigen::Quaterniond turn = R_w_old * loop.T_old_query.rotation * R_w_query.conjugate();
  const Eigen::Vector3d up_query = R_w_query.conjugate() * Eigen::Vector3d::UnitZ();
  const double position_variance = loop.covariance.topLeftCorner<3, 3>().trace() / 3.0;
  const double yaw_variance = up_query.dot(loop.covariance.bottomRightCorner<3, 3>() * up_query);
  return {loop.old_id,
          loop.query_id,
          R_w_old * loop.T_old_query.position,
          yawOf(turn),
          std::hypot(options_.loop_position_sigma, std::sqrt(std::max(0.0, position_variance))),
          std::hypot(options_.loop_yaw_sigma, std::sqrt(std::max(0.0, yaw_variance))),
          true};
}

std::vector<HeadingEdge> KeyframeGraph::edges() const {
  std::vector<HeadingEdge> edges;
  for (const auto& [number, sequence] : sequences_) {
    for (std::size_t to = 1; to < sequence.ids.size(); ++to) {
      const KeyframeVertex& vertex = vertices_.at(sequence.ids[to]);
      const std::size_t reach = predecessorsOf(sequence.ids, to);
      for (std::size_t from = to - reach; from < to; ++from) {
        edges.push_back(sequentialEdge(vertices_.at(sequence.ids[from]), vertex, reach));
      }
    }
  }
  for (const LoopEdge& loop : loops_) edges.push_back(loopEdge(loop));
  return edges;
}

}  // namespace vins::pose_graph
