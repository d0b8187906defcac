#include "pose_graph/pose_graph_options.h"

#include <filesystem>

#include "vins_core/folder.h"
#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

constexpr Range kDistance{0.0, 100.0};
constexpr Range kAngle{0.0, 180.0};
constexpr Range kCount{0, 1000};
constexpr Range kKeyframes{200, 100000};
constexpr Range kInliers{10, 1000};
constexpr Range kDrift{0.0, 1000.0};
constexpr Range kSigma{1e-4, 100.0};

/// A file's path; "" where the key is absent.
std::string fileOf(const Parameters& parameters, const char* key) {
  return pathSeenFrom(parameters.name(), parameters.textOr(key, ""));
}

}  // namespace

void PoseGraphOptions::validate() const {
  loops.validate();
  gate.validate();
  graph.validate();
  optimizer.validate();
  thinning.validate();
  const char* const owner = "pose graph";
  requireWithin(owner, "skip_dis", skip_distance, kDistance);
  requireWithin(owner, "skip_angle", skip_angle, kAngle);
  requireWithin(owner, "skip_crowd", skip_crowd, {1, 1000});
  requireWithin(owner, "skip_neighbours", skip_neighbours, {1, 1000});
  requireWithin(owner, "skip_cnt", skip_count, kCount);
  requireWithin(owner, "found_position_sigma", found_position_sigma, kSigma);
  requireWithin(owner, "found_rotation_sigma", found_rotation_sigma, kSigma);
}

std::ostream& operator<<(std::ostream& out, const PoseGraphOptions& options) {
  return out << "skip_dis: " << options.skip_distance << " m\n"
             << "skip_cnt: " << options.skip_count << "\n"
             << "max_keyframes: " << options.thinning.max_keyframes << "\n"
             << "min_loop_inliers: " << options.loops.verifier.min_inliers << "\n"
             << "loop_max_drift: " << options.gate.position_share << "\n"
             << "position_drift: " << options.graph.position_drift << " m/sqrt(s)\n"
             << "yaw_drift: " << options.graph.yaw_drift << " rad/sqrt(s)\n";
}

PoseGraphConfiguration readPoseGraphConfiguration(const Parameters& parameters) {
  PoseGraphConfiguration result;
  PoseGraphOptions& options = result.options;
  result.is_on = parameters.flagOr("loop_closure", result.is_on);
  options.refines_in_window = parameters.flagOr("fast_relocalization", true);
  result.files.vocabulary = fileOf(parameters, "vocabulary_file");
  result.files.pattern = fileOf(parameters, "brief_pattern_file");
  result.loads_map = parameters.flagOr("load_previous_pose_graph", result.loads_map);
  const std::string map_folder = fileOf(parameters, "pose_graph_save_path");
  if (!map_folder.empty()) {
    result.map_file = (std::filesystem::path(map_folder) / "pose_graph.map").string();
  }
  if (result.loads_map && result.map_file.empty()) {
    parameters.fail("load_previous_pose_graph", "1 without pose_graph_save_path",
                    "0, or 1 beside the folder that holds pose_graph.map");
  }
  result.saves_images = parameters.flagOr("save_image", result.saves_images);
  options.skip_distance = parameters.numberOr("skip_dis", options.skip_distance, kDistance);
  options.skip_count = parameters.integerOr("skip_cnt", options.skip_count, kCount);
  options.thinning.max_keyframes =
      parameters.integerOr("max_keyframes", options.thinning.max_keyframes, kKeyframes);
  options.loops.verifier.min_inliers =
      parameters.integerOr("min_loop_inliers", options.loops.verifier.min_inliers, kInliers);
  options.gate.position_share =
      parameters.numberOr("loop_max_drift", options.gate.position_share, kDrift);
  options.graph.position_drift =
      parameters.numberOr("position_drift", options.graph.position_drift, kSigma);
  options.graph.yaw_drift = parameters.numberOr("yaw_drift", options.graph.yaw_drift, kSigma);
  options.validate();
  return result;
}

}  // namespace vins::pose_graph
