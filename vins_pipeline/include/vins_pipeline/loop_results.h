#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pose_graph/pose_graph.h"
#include "vins_core/trajectory.h"
#include "vins_pipeline/pipeline.h"

namespace vins::pipeline {

/// The trajectories of a run with loop closing: as it was known live, and as it is known in the
/// end. Sequences that no loop has joined to the map are in their own frames.
class LoopResults {
 public:
  void add(const PipelineResult& result);

  /// TUM's form, a line for each odometry: corrected by what was known when its frame came.
  const std::string& live() const { return live_; }

  /// TUM's form, a line for each odometry: moved as the keyframe before it was in the end, or the
  /// first one of its sequence.
  std::string finalPath(const std::vector<pose_graph::SequencePath>& paths) const;

  /// VINS-Mono's vins_result_loop.csv, a line for each keyframe of this run, not of a loaded map:
  /// stamp [ns], px,py,pz [m], qw,qx,qy,qz, in the form of its files (a comma at the end of each
  /// line).
  static std::string vinsMonoCsv(const std::vector<pose_graph::SequencePath>& paths);

 private:
  struct Frame {
    std::uint32_t sequence;
    StampedPose pose;  ///< in the odometry's world
  };

  std::string live_;
  std::vector<Frame> frames_;
};

}  // namespace vins::pipeline
