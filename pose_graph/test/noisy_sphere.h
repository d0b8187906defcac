#pragma once

#include <cmath>
#include <random>

#include "pose_graph/graph/relative_pose_graph.h"
#include "vins_core/so3.h"

namespace vins::pose_graph::testing {

/// Rounds of a sphere one above the other, joined along each round and from each to the next; in a
/// planar graph the rounds are circles around each other. Edges have noise of `noise` (position
/// [m] and rotation [rad]) with the information that fits it; poses stand at the truth.
inline RelativePoseGraph noisySphere(int rounds, int per_round, double noise, bool planar,
                                     std::uint64_t seed) {
  RelativePoseGraph graph;
  graph.planar = planar;
  for (int k = 0; k < rounds * per_round; ++k) {
    const double angle = 2.0 * M_PI * k / per_round;
    const double height = planar ? 0.0 : M_PI * (k + 0.5) / (rounds * per_round);
    const double radius = planar ? 5.0 + 3.0 * k / per_round : 10.0 * std::sin(height);
    const Eigen::Vector3d p(radius * std::cos(angle), radius * std::sin(angle),
                            planar ? 0.0 : -10.0 * std::cos(height));
    graph.poses.push_back(
        {k, {so3::exp({0.0, 0.0, angle}) * so3::exp({0.0, height, 0.0}), p}, false});
  }
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto add = [&](int i, int j) {
    se3::Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = noise * normal(random);
    if (planar) xi[2] = xi[3] = xi[4] = 0.0;
    const Pose T_ij = graph.poses[std::size_t(i)].T_wi.inverse() * graph.poses[std::size_t(j)].T_wi;
    const double weight = noise > 0.0 ? 1.0 / (noise * noise) : 1.0;
    graph.edges.push_back({i, j, T_ij * se3::exp(xi), weight * se3::Matrix6d::Identity()});
  };
  for (int k = 1; k < rounds * per_round; ++k) {
    add(k - 1, k);
    if (k >= per_round) add(k - per_round, k);
  }
  return graph;
}

}  // namespace vins::pose_graph::testing
