// The covariances that are published, judged by the messages alone, as a subscriber sees them. No
// master is needed: the messages are made by the nodes' own conversions.

#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>

#include "estimator_messages.h"
#include "pose_graph_messages.h"
#include "simulation/odometry_study.h"
#include "simulation/parallel_for.h"
#include "simulation/random.h"
#include "vins_core/heading.h"
#include "vins_core/so3.h"

namespace vins::tests {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using simulation::OdometryRun;
using simulation::OdometrySample;

constexpr int kSeeds = 20;

/// NEES per degree of freedom, averaged: by block.
struct Blocks {
  double position = 0.0;
  double rotation = 0.0;
  double velocity = 0.0;
  double rate = 0.0;
  double count = 0.0;

  void add(const Blocks& other) {
    position += other.position;
    rotation += other.rotation;
    velocity += other.velocity;
    rate += other.rate;
    count += other.count;
  }
};

Vector3d vectorOf(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

/// By ROS's definition: row-major, about fixed axes. On purpose not by our own conversions.
template <typename Covariance>
Matrix3d blockOf(const Covariance& covariance, int begin) {
  Matrix3d block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      block(i, j) = covariance[static_cast<std::size_t>(6 * (begin + i) + begin + j)];
    }
  }
  return block;
}

double nees(const Vector3d& error, const Matrix3d& covariance) {
  const Eigen::LLT<Matrix3d> cholesky(covariance);
  EXPECT_EQ(cholesky.info(), Eigen::Success) << covariance;
  return error.dot(cholesky.solve(error)) / 3.0;
}

/// What the message should have said, in the frame of the message.
struct Truth {
  Pose T_fb;
  Vector3d velocity_f;
  Vector3d angular_velocity_b;
};

Truth movedBy(const Pose& T, const Truth& truth) {
  return {T * truth.T_fb, T.rotation * truth.velocity_f, truth.angular_velocity_b};
}

Blocks judge(const nav_msgs::Odometry& message, const Truth& truth) {
  const geometry_msgs::Pose& pose = message.pose.pose;
  const Vector3d p(pose.position.x, pose.position.y, pose.position.z);
  const Eigen::Quaterniond R(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                             pose.orientation.z);
  const Vector3d velocity_b = truth.T_fb.rotation.conjugate() * truth.velocity_f;
  Blocks blocks;
  blocks.position = nees(truth.T_fb.position - p, blockOf(message.pose.covariance, 0));
  blocks.rotation =
      nees(so3::log(truth.T_fb.rotation * R.conjugate()), blockOf(message.pose.covariance, 3));
  blocks.velocity =
      nees(velocity_b - vectorOf(message.twist.twist.linear), blockOf(message.twist.covariance, 0));
  blocks.rate = nees(truth.angular_velocity_b - vectorOf(message.twist.twist.angular),
                     blockOf(message.twist.covariance, 3));
  blocks.count = 1.0;
  return blocks;
}

/// A relocalization with a known covariance: where the map says that the odometry's world is.
struct Relocalization {
  Pose truth;
  pose_graph::MapFromOdom estimate;
};

Relocalization relocalize(std::uint64_t seed) {
  constexpr double kPosition = 0.05, kYaw = 0.02;  // deviations [m], [rad]
  simulation::Random random(seed, "relocalization");
  Relocalization result;
  result.truth = {yawRotation(2.0), {3.0, -4.0, 1.0}};
  const double yaw = kYaw * random.normal();
  result.estimate.pose = {yawRotation(2.0 + yaw),
                          result.truth.position + kPosition * random.normal3()};
  result.estimate.covariance.diagonal().head<3>().setConstant(kPosition * kPosition);
  result.estimate.covariance(5, 5) = kYaw * kYaw;
  return result;
}

using Topics = std::map<std::string, Blocks>;

Topics judgeFlight(std::uint64_t seed) {
  simulation::OdometryStudyOptions options;
  options.features.duration = 12.0;
  options.features.max_features = 100;
  options.propagates = true;
  const OdometryRun run = runOdometry(options, seed);
  EXPECT_FALSE(run.samples.empty()) << seed;
  const Pose T_odom_world = simulation::alignPositionAndYaw(run.samples.front().gauge->truth,
                                                            run.samples.front().gauge->estimate);
  const Relocalization map = relocalize(seed);
  Topics topics;
  for (const OdometrySample& sample : run.samples) {
    const nav_msgs::Odometry odometry = estimator::toOdometry(sample.estimate, {});
    const Truth truth = movedBy(
        T_odom_world, {sample.truth.T_wb, sample.truth.v_w, sample.true_angular_velocity_b});
    topics["odometry"].add(judge(odometry, truth));
    topics["pose graph's odometry"].add(
        judge(pose_graph::toMapOdometry(odometry, map.estimate, "map"), movedBy(map.truth, truth)));
  }
  for (const simulation::PropagatedSample& sample : run.propagated) {
    const Truth truth = movedBy(
        T_odom_world, {sample.truth.T_wb, sample.truth.v_w, sample.true_angular_velocity_b});
    topics["imu_propagate"].add(judge(estimator::toOdometry(sample.estimate, {}), truth));
  }
  return topics;
}

TEST(MessageConsistency, CovariancesMeanWhatRosSaysTheyMean) {
  std::vector<Topics> flights(kSeeds);
  simulation::parallelFor(kSeeds, 2, [&](int i) {
    flights[static_cast<std::size_t>(i)] = judgeFlight(static_cast<std::uint64_t>(i) + 1);
  });
  Topics sums;
  for (const Topics& flight : flights) {
    for (const auto& [topic, blocks] : flight) sums[topic].add(blocks);
  }
  ASSERT_EQ(sums.size(), 3u);
  for (const auto& [topic, sum] : sums) {
    ASSERT_GT(sum.count, 100.0 * kSeeds) << topic;
    const std::vector<std::pair<const char*, double>> means = {
        {"position", sum.position / sum.count},
        {"rotation", sum.rotation / sum.count},
        {"velocity", sum.velocity / sum.count},
        {"rate", sum.rate / sum.count}};
    for (const auto& [block, mean] : means) {
      RecordProperty(topic + ", " + block, std::to_string(mean));
      std::cout << topic << ", " << block << ": " << mean << "\n";
      EXPECT_GT(mean, 0.7) << topic << ", " << block;
      EXPECT_LT(mean, 1.3) << topic << ", " << block;
    }
  }
}

}  // namespace
}  // namespace vins::tests
