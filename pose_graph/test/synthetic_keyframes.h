#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "pose_graph/graph/heading.h"
#include "pose_graph/graph/keyframe_graph.h"
#include "vins_core/pose.h"
#include "vins_core/so3.h"

namespace vins::pose_graph::testing {

/// A body that flies round and round, with an odometry that drifts in position and yaw.
struct SyntheticKeyframes {
  static constexpr Stamp kPeriod = 500'000'000;  ///< between keyframes [ns]

  /// `per_round` keyframes make a round of radius 5 m, with waves in height, roll and pitch.
  /// `tilt`: constant rotation of the body, so that any axis may point up.
  SyntheticKeyframes(int count, int per_round, double noise, std::uint64_t seed,
                     const Eigen::Quaterniond& tilt = Eigen::Quaterniond::Identity()) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Pose T_wt;  // odometry world <- truth, with yaw only: what the drift has come to
    for (int i = 0; i < count; ++i) {
      truth.push_back(trueMotion(2.0 * M_PI * i / per_round, tilt));
      if (i > 0) {
        const Eigen::Vector3d slip(noise * normal(random), noise * normal(random),
                                   noise * normal(random));
        const Pose turn(yawRotation(0.1 * noise * normal(random)), slip);
        // The turn acts where the body is, as a gyroscope's error does.
        const Pose here({1.0, 0.0, 0.0, 0.0}, truth.back().position);
        T_wt = T_wt * here * turn * here.inverse();
      }
      odometry.push_back(T_wt * truth.back());
    }
  }

  /// All keyframes as one sequence; ids and stamps count from `first`.
  void addTo(KeyframeGraph* graph, std::uint32_t sequence = 0, std::int64_t first = 0) const {
    for (std::size_t i = 0; i < odometry.size(); ++i) {
      const auto id = first + static_cast<std::int64_t>(i);
      graph->addKeyframe(id, sequence, kPeriod * (id + 1), odometry[i]);
    }
  }

  /// A loop as the truth has it.
  LoopEdge loop(std::size_t old, std::size_t query) const {
    LoopEdge edge;
    edge.old_id = static_cast<std::int64_t>(old);
    edge.query_id = static_cast<std::int64_t>(query);
    edge.T_old_query = truth[old].inverse() * truth[query];
    return edge;
  }

  std::vector<Pose> truth;     ///< in the map
  std::vector<Pose> odometry;  ///< in the odometry's world; the first pose is the truth's

 private:
  static Pose trueMotion(double angle, const Eigen::Quaterniond& tilt) {
    const Eigen::Vector3d p(5.0 * std::cos(angle), 5.0 * std::sin(angle), std::sin(0.7 * angle));
    const Eigen::Vector3d lean(0.2 * std::sin(1.3 * angle), 0.1 * std::cos(angle), 0.0);
    return {yawRotation(angle) * so3::exp(lean) * tilt, p};
  }
};

/// Root mean square distance of the graph's keyframes 0, 1, ... from the truth [m].
inline double positionError(const KeyframeGraph& graph, const std::vector<Pose>& truth) {
  double sum = 0.0;
  for (const auto& [id, vertex] : graph.vertices()) {
    sum += (vertex.T_mb.position - truth[static_cast<std::size_t>(id)].position).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(graph.vertices().size()));
}

/// Root mean square error of the loops' positions, by the poses that the graph has [m].
inline double loopError(const KeyframeGraph& graph, const std::vector<Pose>& truth) {
  double sum = 0.0;
  for (const LoopEdge& loop : graph.loops()) {
    const Pose T_oq =
        graph.vertices().at(loop.old_id).T_mb.inverse() * graph.vertices().at(loop.query_id).T_mb;
    const Pose T_oq_true = truth[static_cast<std::size_t>(loop.old_id)].inverse() *
                           truth[static_cast<std::size_t>(loop.query_id)];
    sum += (T_oq.position - T_oq_true.position).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(graph.loops().size()));
}

/// Trust in loops that are exact.
inline KeyframeGraphOptions exactLoops() {
  KeyframeGraphOptions options;
  options.loop_position_sigma = 0.005;
  options.loop_yaw_sigma = 0.001;
  options.position_drift = 0.02;
  options.yaw_drift = 0.002;
  return options;
}

/// Difference of two poses: position [m] and rotation [rad] together.
inline double difference(const Pose& a, const Pose& b) { return se3::log(a.inverse() * b).norm(); }

}  // namespace vins::pose_graph::testing
