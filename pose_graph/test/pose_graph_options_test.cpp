#include "pose_graph/pose_graph_options.h"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

PoseGraphConfiguration read(const std::string& text) {
  return readPoseGraphConfiguration(Parameters::parse(text, "rigs/rig.yaml"));
}

std::string errorOf(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PoseGraphOptions, AnEmptyConfigurationGivesTheDefaults) {
  const PoseGraphConfiguration config = read("a: 1\n");
  EXPECT_TRUE(config.is_on);
  EXPECT_TRUE(config.options.refines_in_window);
  EXPECT_FALSE(config.loads_map);
  EXPECT_EQ(config.files.vocabulary, "");
  EXPECT_EQ(config.options.thinning.max_keyframes, 2000);
  EXPECT_EQ(config.options.skip_distance, 0.05);
  EXPECT_NO_THROW(config.options.validate());
}

TEST(PoseGraphOptions, ReadsTheKeysOfVinsMonoAndItsOwn) {
  const PoseGraphConfiguration config = read(
      "loop_closure: 0\nfast_relocalization: 0\nskip_dis: 0\nskip_cnt: 2\n"
      "load_previous_pose_graph: 1\npose_graph_save_path: \"/maps/\"\nsave_image: 1\n"
      "vocabulary_file: words.voc\nbrief_pattern_file: \"/share/pattern.yml\"\n"
      "max_keyframes: 500\nmin_loop_inliers: 30\n");
  EXPECT_FALSE(config.is_on);
  EXPECT_FALSE(config.options.refines_in_window);
  EXPECT_EQ(config.options.skip_distance, 0.0);
  EXPECT_EQ(config.options.skip_count, 2);
  EXPECT_TRUE(config.loads_map);
  EXPECT_EQ(config.map_file, "/maps/pose_graph.map");
  EXPECT_TRUE(config.saves_images);
  EXPECT_EQ(config.files.vocabulary, "rigs/words.voc") << "seen from the configuration's folder";
  EXPECT_EQ(config.files.pattern, "/share/pattern.yml");
  EXPECT_EQ(config.options.thinning.max_keyframes, 500);
  EXPECT_EQ(config.options.loops.verifier.min_inliers, 30);
}

TEST(PoseGraphOptions, MapsAreInTheirFolder) {
  EXPECT_EQ(read("a: 1\n").map_file, "");
  EXPECT_EQ(read("pose_graph_save_path: maps\n").map_file, "rigs/maps/pose_graph.map")
      << "seen from the configuration's folder";
  const std::string error = errorOf("load_previous_pose_graph: 1");
  EXPECT_NE(error.find("pose_graph_save_path"), std::string::npos) << error;
}

TEST(PoseGraphOptions, ErrorsNameFileKeyAndValue) {
  for (const char* bad : {"skip_dis: -1", "skip_cnt: 1.5", "max_keyframes: 3",
                          "min_loop_inliers: 2", "loop_closure: 7"}) {
    const std::string key = std::string(bad).substr(0, std::string(bad).find(':'));
    const std::string error = errorOf(bad);
    EXPECT_NE(error.find("rigs/rig.yaml"), std::string::npos) << bad << ": " << error;
    EXPECT_NE(error.find("'" + key + "'"), std::string::npos) << bad << ": " << error;
  }
}

TEST(PoseGraphOptions, ValidateLooksAtEveryPart) {
  const auto isRefused = [](auto change) {
    PoseGraphOptions options;
    change(&options);
    EXPECT_THROW(options.validate(), InputError);
  };
  isRefused([](auto* o) { o->loops.min_interval = -1.0; });
  isRefused([](auto* o) { o->loops.verifier.min_inliers = -1; });
  isRefused([](auto* o) { o->graph.predecessors = 0; });
  isRefused([](auto* o) { o->graph.predecessor_seconds = -1.0; });
  isRefused([](auto* o) { o->thinning.max_keyframes = -1; });
  isRefused([](auto* o) { o->thinning.loops_per_keyframe = 0.0; });
  isRefused([](auto* o) { o->skip_distance = -0.1; });
  isRefused([](auto* o) { o->skip_crowd = 0; });
  isRefused([](auto* o) { o->skip_neighbours = 0; });
  isRefused([](auto* o) { o->found_position_sigma = 0.0; });
  isRefused([](auto* o) { o->found_rotation_sigma = 0.0; });
}

TEST(PoseGraphOptions, PrintsWhatAUserMayWantToKnow) {
  std::ostringstream out;
  out << PoseGraphOptions();
  EXPECT_NE(out.str().find("max_keyframes: 2000"), std::string::npos) << out.str();
}

}  // namespace
}  // namespace vins::pose_graph
