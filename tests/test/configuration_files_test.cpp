// Every file of config/ loads, with no key that nothing knows; and so does a file as VINS-Mono's
// users have it.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "camera_model/camera_file.h"
#include "vins_pipeline/pipeline.h"

namespace vins::tests {
namespace {

namespace fs = std::filesystem;

/// Files below config/ with this end of their names.
std::vector<fs::path> filesWith(const std::string& end) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator("../config")) {
    const std::string name = entry.path().filename().string();
    const bool fits = name.size() > end.size() && name.substr(name.size() - end.size()) == end;
    if (fits) files.push_back(entry.path());
  }
  return files;
}

/// In the form of VINS-Mono's documentation, with the keys that its EuRoC file has.
const char* const kVinsMonoFile = "launch_files/vins_mono_euroc.yaml";

class ConfigurationFiles : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& text) {
    fs::create_directories(folder_);
    const fs::path file = folder_ / "config.yaml";
    std::ofstream(file) << text;
    return file.string();
  }

  fs::path folder_ =
      fs::temp_directory_path() / ("configuration_files_test_" + std::to_string(getpid()));
};

TEST_F(ConfigurationFiles, EveryRigLoadsAndHasNoUnknownKey) {
  const std::vector<fs::path> files = filesWith("_config.yaml");
  EXPECT_GE(files.size(), 4u);
  for (const fs::path& file : files) {
    std::vector<std::string> warnings;
    const pipeline::PipelineOptions options =
        pipeline::readPipelineOptions(file.string(), &warnings);
    EXPECT_TRUE(warnings.empty()) << warnings.front();
    EXPECT_FALSE(options.imu_topic.empty()) << file;
    EXPECT_TRUE(options.loops.is_on) << file;
  }
}

TEST_F(ConfigurationFiles, EveryCameraLoadsAndHasNoUnknownKey) {
  const std::vector<fs::path> files = filesWith("_camera.yaml");
  EXPECT_GE(files.size(), 4u);
  for (const fs::path& file : files) {
    const Parameters parameters = Parameters::load(file.string());
    const auto camera = camera_model::readCamera(parameters);
    const std::vector<std::string> warnings = parameters.warnings();
    EXPECT_TRUE(warnings.empty()) << warnings.front();
  }
}

TEST_F(ConfigurationFiles, FisheyeRigsLookFarToTheSideAndMaskTheRim) {
  for (const std::string rig : {"tum_vi", "realsense_t265"}) {
    const std::string file = "../config/" + rig + "/" + rig + "_config.yaml";
    const pipeline::PipelineOptions options = pipeline::readPipelineOptions(file, nullptr);
    const camera_model::ImageSize size = options.cameras[0]->imageSize();
    // Over 65 degrees from the axis at the mask's edge: no pinhole camera has that.
    const auto ray =
        options.cameras[0]->unproject(Eigen::Vector2d(0.02 * size.width, 0.5 * size.height));
    ASSERT_TRUE(ray) << rig;
    EXPECT_LT(ray->normalized().z(), std::cos(65.0 * M_PI / 180.0)) << rig;
    ASSERT_FALSE(options.mask.empty()) << rig;
    EXPECT_EQ(options.mask.at<unsigned char>(0, 0), 0) << rig;
    EXPECT_NE(options.mask.at<unsigned char>(size.height / 2, size.width / 2), 0) << rig;
  }
}

TEST_F(ConfigurationFiles, VinsMonosOwnFormRunsUnchanged) {
  std::vector<std::string> warnings;
  const pipeline::PipelineOptions options = pipeline::readPipelineOptions(kVinsMonoFile, &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  EXPECT_EQ(options.imu_topic, "/imu0");
  EXPECT_EQ(options.image_topics[0], "/cam0/image_raw");
  EXPECT_EQ(options.cameras[0]->imageSize().width, 752);
  EXPECT_EQ(options.tracker.frequency, 10.0);
  // A deviation of one sample at 200 Hz, as VINS-Mono means it, not a density.
  EXPECT_NEAR(options.estimator.imu.accelerometer_noise, 0.08 / std::sqrt(200.0), 1e-9);
  EXPECT_TRUE(options.loops.is_on);
  EXPECT_FALSE(options.loops.options.refines_in_window);
  EXPECT_TRUE(options.loops.saves_images);
}

/// A second reader would miss what the first one understands, as four did.
TEST_F(ConfigurationFiles, NothingButTheReaderOfRigsAsksForARigsKeys) {
  const std::vector<std::string> keys = {"imu_topic",         "image_topic", "estimate_extrinsic",
                                         "extrinsicRotation", "body_T_cam0", "cam0_calib",
                                         "timeshift_cam_imu", "rostopic"};
  int files = 0;
  for (const std::string package : {"vins_core", "vins_msgs", "camera_model", "feature_tracker",
                                    "vins_estimator", "pose_graph", "vins_pipeline"}) {
    for (const auto& entry : fs::recursive_directory_iterator("../" + package)) {
      const std::string path = entry.path().string(), name = entry.path().filename().string();
      const bool is_source = entry.path().extension() == ".cpp" || entry.path().extension() == ".h";
      const bool is_reader = package == "camera_model" && name.rfind("rig", 0) == 0;
      if (!is_source || is_reader || name == "rig_keys.cpp") continue;
      if (path.find("/test/") != std::string::npos) continue;
      ++files;
      std::ifstream in(path);
      const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      for (const std::string& key : keys) {
        EXPECT_EQ(text.find("\"" + key + "\""), std::string::npos) << path << " asks for " << key;
      }
    }
  }
  EXPECT_GT(files, 200);
}

TEST_F(ConfigurationFiles, AMisspeltKeyIsNamedWithTheOneThatIsMeant) {
  std::vector<std::string> warnings;
  std::ifstream in(kVinsMonoFile);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  pipeline::readPipelineOptions(write(text + "max_cn: 100\n"), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'max_cn'"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("'max_cnt'"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace vins::tests
