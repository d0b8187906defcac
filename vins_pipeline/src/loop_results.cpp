#include "vins_pipeline/loop_results.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "pose_graph/graph/heading.h"
#include "vins_core/trajectory_file.h"

namespace vins::pipeline {
namespace {

/// map <- odometry's world at a time, by the keyframe before it or else the first.
Pose driftAt(const pose_graph::SequencePath& path, Stamp stamp) {
  if (path.keyframes.empty()) return {};
  auto after = std::upper_bound(
      path.keyframes.begin(), path.keyframes.end(), stamp,
      [](Stamp time, const pose_graph::KeyframeVertex& keyframe) { return time < keyframe.stamp; });
  if (after != path.keyframes.begin()) --after;
  return pose_graph::driftOf(after->T_mb, after->T_wb);
}

std::string csvLine(const pose_graph::KeyframeVertex& keyframe) {
  const Pose& T = keyframe.T_mb;
  char line[256];
  std::snprintf(line, sizeof(line), "%lld,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,\n",
                static_cast<long long>(keyframe.stamp), T.position.x(), T.position.y(),
                T.position.z(), T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z());
  return line;
}

}  // namespace

void LoopResults::add(const PipelineResult& result) {
  for (const StampedPose& pose : result.corrected) live_ += toTumLine(pose) + "\n";
  for (const estimator::EstimatorResult& estimate : result.estimates) {
    if (!estimate.odometry) continue;
    const estimator::Odometry& odometry = *estimate.odometry;
    frames_.push_back({odometry.sequence, {odometry.stamp, odometry.state.T_wb}});
  }
}

std::string LoopResults::finalPath(const std::vector<pose_graph::SequencePath>& paths) const {
  std::map<pose_graph::SequenceNumber, const pose_graph::SequencePath*> by_sequence;
  for (const pose_graph::SequencePath& path : paths) by_sequence[path.sequence] = &path;
  std::string text;
  for (const Frame& frame : frames_) {
    const auto path = by_sequence.find(frame.sequence);
    const Pose T_mw = path == by_sequence.end() ? Pose() : driftAt(*path->second, frame.pose.stamp);
    text += toTumLine({frame.pose.stamp, T_mw * frame.pose.T_wb}) + "\n";
  }
  return text;
}

std::string LoopResults::vinsMonoCsv(const std::vector<pose_graph::SequencePath>& paths) {
  std::string text;
  for (const pose_graph::SequencePath& path : paths) {
    if (path.sequence < 0) continue;
    for (const pose_graph::KeyframeVertex& keyframe : path.keyframes) text += csvLine(keyframe);
  }
  return text;
}

}  // namespace vins::pipeline
