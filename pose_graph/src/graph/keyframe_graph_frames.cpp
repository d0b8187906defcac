// Where the frames of sequences stand to each other: how a loop joins them, what is carried over.

#include <algorithm>

#include "pose_graph/graph/heading.h"
#include "pose_graph/graph/keyframe_graph.h"
#include "vins_core/pose_covariance.h"

namespace vins::pose_graph {

const KeyframeGraph::Sequence* KeyframeGraph::newestOf(std::optional<std::uint32_t> world) const {
  if (!world) return nullptr;
  const auto found = std::find_if(sequences_.rbegin(), sequences_.rend(),
                                  [&](const auto& item) { return item.second.world == world; });
  return found == sequences_.rend() ? nullptr : &found->second;
}

Pose KeyframeGraph::correctionOf(const LoopEdge& edge) const {
  const KeyframeVertex& query = vertices_.at(edge.query_id);
  const KeyframeVertex& old = vertices_.at(edge.old_id);
  const HeadingEdge relative = loopEdge(edge);
  const Pose T_mw_old = driftOf(old.T_mb, old.T_wb);
  const Pose T_mw_query = driftOf(query.T_mb, query.T_wb);
  const Eigen::Quaterniond R_mw = T_mw_old.rotation * yawRotation(relative.yaw);
  const Eigen::Vector3d p_m = old.T_mb.position + T_mw_old.rotation * relative.position;
  return Pose(R_mw, p_m - R_mw * query.T_wb.position) * T_mw_query.inverse();
}

void KeyframeGraph::joinComponents(SequenceNumber older, SequenceNumber younger) {
  for (auto& [number, sequence] : sequences_) {
    if (sequence.component == younger) sequence.component = older;
  }
}

se3::Matrix6d KeyframeGraph::covarianceOfCorrection(const KeyframeVertex& fixed,
                                                    const KeyframeVertex& moved,
                                                    const Pose& T_new_old,
                                                    const LoopEdge& edge) const {
  const HeadingEdge loop = loopEdge(edge);
  se3::Matrix6d of_loop = se3::Matrix6d::Zero();
  of_loop.diagonal().head<3>().setConstant(loop.position_sigma * loop.position_sigma);
  of_loop(5, 5) = loop.yaw_sigma * loop.yaw_sigma;
  // The moved keyframe is where the fixed one and the loop say. The fixed one's odometry has its
  // own covariance and is not counted here.
  const Sequence& of_fixed = sequences_.at(fixed.sequence);
  const Pose at_fixed(Eigen::Quaterniond::Identity(), fixed.T_wb.position);
  const Pose at_moved(Eigen::Quaterniond::Identity(),
                      (T_new_old * moved.T_mb).position - fixed.T_mb.position);
  const se3::Matrix6d of_fixed_pose =
      covarianceOfProduct(of_fixed.T_mw, of_fixed.covariance, at_fixed, se3::Matrix6d::Zero());
  const se3::Matrix6d of_moved_pose = covarianceOfProduct(
      {Eigen::Quaterniond::Identity(), fixed.T_mb.position}, of_fixed_pose, at_moved, of_loop);
  return covarianceByPoint(T_new_old.rotation * moved.T_mb.position, of_moved_pose);
}

/// `measured`: the sequence that the correction was measured of, whatever was known of it before.
void KeyframeGraph::moveComponent(SequenceNumber component, const MapFromOdom& T_new_old,
                                  SequenceNumber measured) {
  for (auto& [number, sequence] : sequences_) {
    if (sequence.component != component) continue;
    for (const std::int64_t id : sequence.ids) {
      KeyframeVertex& vertex = vertices_.at(id);
      vertex.T_mb = T_new_old.pose * vertex.T_mb;
    }
    if (number == measured) sequence.covariance.setZero();
    sequence.covariance = covarianceOfProduct(T_new_old.pose, T_new_old.covariance, sequence.T_mw,
                                              sequence.covariance);
    sequence.T_mw = T_new_old.pose * sequence.T_mw;
  }
}

bool KeyframeGraph::placeSequence(SequenceNumber sequence, const MapFromOdom& place) {
  const auto found = sequences_.find(sequence);
  if (found == sequences_.end() || found->second.component != sequence) return false;
  const Pose T_new_old = place.pose * found->second.T_mw.inverse();
  // The correction itself: what carries the place's covariance back to it.
  const Pose& T_old_mw = found->second.T_mw;
  const se3::Matrix6d covariance =
      covarianceByPoint(T_new_old.rotation * T_old_mw.position, place.covariance);
  moveComponent(sequence, {T_new_old, covariance}, sequence);
  return true;
}

std::optional<MapFromOdom> KeyframeGraph::mapFromOdom(SequenceNumber sequence) const {
  const auto found = sequences_.find(sequence);
  if (found == sequences_.end()) return std::nullopt;
  return MapFromOdom{found->second.T_mw, found->second.covariance};
}

bool KeyframeGraph::beginsWorld(SequenceNumber sequence) const {
  const auto found = sequences_.find(sequence);
  if (found == sequences_.end()) return false;
  return std::none_of(sequences_.begin(), found, [&](const auto& item) {
    return item.second.world && item.second.world == found->second.world;
  });
}

}  // namespace vins::pose_graph
