// The program, run as a user runs it.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sys/wait.h>

#include "vins_core/parameters.h"
#include "vins_core/testing/shared_data.h"
#include "vins_pipeline/bag_writer.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

const char* const kConfig = "../config/euroc/euroc_config.yaml";

struct Outcome {
  int exit_code = 0;
  std::string output;
};

std::string textOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RunBag : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path path(const std::string& name) const { return folder_ / name; }

  /// `interrupt_at`: Ctrl-C as soon as this is in its output.
  Outcome run(const std::string& arguments, const std::string& interrupt_at = "") const {
    const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "run_bag";
    const fs::path log = folder_ / "log.txt";
    std::string command = tool.string() + " " + arguments + " > " + log.string() + " 2>&1";
    if (!interrupt_at.empty()) {
      command += " & p=$!; while kill -0 $p && ! grep -q '" + interrupt_at + "' " + log.string() +
                 "; do sleep 0.1; done; kill -INT $p; wait $p";
    }
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), textOf(log)};
  }

  /// A quarter of a second of noise from a rig that lies still: too short to start from.
  std::string writeBag(const std::string& name, cv::Size size = {752, 480}) const {
    BagWriter bag(path(name).string());
    cv::Mat image(size, CV_8UC1);
    cv::RNG random(3);
    random.fill(image, cv::RNG::UNIFORM, 0, 255);
    for (int i = 0; i <= 50; ++i) {
      const Stamp now = 1'600'000'000'000'000'000 + i * Stamp{5'000'000};
      bag.writeImu(now, {now, {9.81, 0.0, 0.0}, {0.0, 0.0, 0.0}});
      bag.writeGroundTruth(now, now, {});
      if (i % 10 == 0) bag.writeImage(topic::kCamera0, now, now, image);
    }
    bag.finish();
    return path(name).string();
  }

 private:
  fs::path folder_ = fs::path(::testing::TempDir()) / "run_bag_test";
};

/// Adds a message of EuRoC's left camera to a bag, with this model of its distortion.
void addCameraInfo(const std::string& path, const std::string& distortion_model) {
  sensor_msgs::CameraInfo info;
  info.width = 752;
  info.height = 480;
  info.distortion_model = distortion_model;
  info.K = {458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1};
  info.D = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0};
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  bag.write("/cam0/camera_info", ros::Time(1'600'000'000, 0), info);
}

/// EuRoC's configuration with camera_info_topic, and without its camera where that is wanted.
std::string withCameraInfo(bool keeps_camera) {
  std::istringstream lines(textOf(kConfig));
  std::string text, line;
  bool is_camera = false;
  while (std::getline(lines, line)) {
    if (line.rfind("   ", 0) != 0) {
      is_camera = line.rfind("model_type", 0) == 0 || line.rfind("projection_parameters", 0) == 0 ||
                  line.rfind("distortion_parameters", 0) == 0;
    }
    if (keeps_camera || !is_camera) text += line + "\n";
  }
  return text + "camera_info_topic: /cam0/camera_info\n";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(RunBag, ARecordingTooShortToStartIsToldByTheExitCodeAndWrittenAllTheSame) {
  const std::string bag = writeBag("short.bag");
  const fs::path out = path("new/folder");
  const Outcome outcome = run(std::string(kConfig) + " " + bag + " --out " + out.string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "initialised   never")) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "6 images, 51 IMU samples")) << outcome.output;
  EXPECT_TRUE(fs::exists(out / "vio_live.txt"));
  EXPECT_TRUE(fs::exists(out / "vins_result_no_loop.csv"));
  EXPECT_TRUE(contains(textOf(out / "events.csv"), "#stamp [ns],severity"));
  const Parameters timing = Parameters::load((out / "timing.json").string());
  EXPECT_EQ(timing.section("stages").section("tracker").integer("count"), 6);
  EXPECT_NEAR(timing.number("data_seconds"), 0.25, 1e-6);
}

TEST_F(RunBag, TakesTheIntrinsicsThatTheFileLacksFromCameraInfo) {
  const std::string bag = writeBag("info.bag");
  addCameraInfo(bag, "plumb_bob");
  std::ofstream(path("no_camera.yaml")) << withCameraInfo(false);
  const std::string config = path("no_camera.yaml").string();
  const Outcome outcome = run(config + " " + bag + " --out " + path("out").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "6 images, 51 IMU samples")) << outcome.output;
  const Outcome no_topic = run(config + " " + writeBag("a.bag") + " --out " + path("o").string());
  EXPECT_EQ(no_topic.exit_code, 1);
  EXPECT_TRUE(contains(no_topic.output, "has no topic '/cam0/camera_info'")) << no_topic.output;
  const std::string unknown = writeBag("unknown.bag");
  addCameraInfo(unknown, "thin_prism");
  const Outcome refused = run(config + " " + unknown + " --out " + path("o").string());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.output,
                       "/cam0/camera_info: camera_info: distortion_model is 'thin_prism'; allowed"))
      << refused.output;
}

TEST_F(RunBag, WarnsWhereTheFilesCameraIsNotThatOfCameraInfo) {
  const std::string bag = writeBag("info.bag");
  addCameraInfo(bag, "plumb_bob");
  const std::string out = " --out " + path("out").string();
  std::string text = withCameraInfo(true);
  std::ofstream(path("same.yaml")) << text;
  const Outcome same = run(path("same.yaml").string() + " " + bag + out);
  EXPECT_FALSE(contains(same.output, "differs from")) << same.output;
  text.replace(text.find("fx: 4"), 5, "fx: 5");
  std::ofstream(path("other.yaml")) << text;
  const Outcome other = run(path("other.yaml").string() + " " + bag + out);
  EXPECT_EQ(other.exit_code, 2) << other.output;
  EXPECT_TRUE(contains(other.output, "differs from that of /cam0/camera_info (752 x 480, fx 458"))
      << other.output;
}

TEST_F(RunBag, DrawsTheTracksOfOneImage) {
  const std::string bag = writeBag("short.bag");
  const std::string arguments = std::string(kConfig) + " " + bag + " --out " + path("out").string();
  const Outcome outcome = run(arguments + " --draw-tracks 0.12");
  EXPECT_TRUE(contains(outcome.output, "estimator.csv, tracks.png")) << outcome.output;
  const cv::Mat picture = cv::imread(path("out/tracks.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(picture.size(), cv::Size(752, 480));
  EXPECT_EQ(picture.type(), CV_8UC3);
  // A line for each image and one for the names.
  const std::string tracks = textOf(path("out/tracker.csv"));
  EXPECT_EQ(std::count(tracks.begin(), tracks.end(), '\n'), 7);
  // Nothing is drawn of a time after the end.
  fs::remove(path("out/tracks.png"));
  EXPECT_FALSE(contains(run(arguments + " --draw-tracks 1").output, "tracks.png"));
  EXPECT_FALSE(fs::exists(path("out/tracks.png")));
}

TEST_F(RunBag, ErrorsTellWhatIsWrongBeforeAnythingIsWritten) {
  const std::string bag = writeBag("a.bag");
  const std::string small = writeBag("small.bag", {320, 240});
  std::string other_topic = textOf(kConfig);
  other_topic.replace(other_topic.find("\"/imu0\""), 7, "\"/imu\"");
  std::ofstream(path("topic.yaml")) << other_topic;
  std::ofstream(path("bad.yaml")) << textOf(kConfig) << "\nwindow_size: 2\n";
  const std::string config = kConfig;
  const struct {
    std::string arguments;
    std::string expected;
  } cases[] = {
      {config, "the option '--bag' is required"},
      {config + " " + bag + " --speed 2", "unrecognised option '--speed'"},
      {"/no/config.yaml " + bag, "/no/config.yaml: cannot be opened"},
      {path("bad.yaml").string() + " " + bag, "key 'window_size': found '2'; allowed"},
      {config + " /no/such.bag", "/no/such.bag: is not there"},
      {path("topic.yaml").string() + " " + bag, "has no topic '/imu'; it has /cam0/image_raw"},
      {config + " " + bag + " --start 9", "nothing from second 9 on"},
      {config + " " + bag + " --duration 0", "duration: found 0"},
      {config + " " + bag + " --load-map /no/such.map", "/no/such.map: is no map file"},
      {config + " " + bag + " --no-loop --save-map a.map", "--save-map: a map needs loop closing"},
      {config + " " + kConfig, "cannot be read as a bag"}};
  for (const auto& c : cases) {
    const Outcome outcome = run(c.arguments + " --out " + path("out").string());
    EXPECT_EQ(outcome.exit_code, 1) << c.arguments << "\n" << outcome.output;
    EXPECT_TRUE(contains(outcome.output, c.expected)) << outcome.output;
    EXPECT_FALSE(fs::exists(path("out"))) << c.arguments;
  }
  const Outcome outcome = run(config + " " + small + " --out " + path("out").string());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.output,
                       "found images of 320x240; allowed by the configuration's "
                       "camera: 752x480"))
      << outcome.output;
}

TEST_F(RunBag, ABadImageCostsThatImageOnly) {
  const fs::path bag = path("bad.bag");
  {
    BagWriter writer(bag.string());
    for (int i = 0; i <= 50; ++i) {
      const Stamp now = 1'600'000'000'000'000'000 + i * Stamp{5'000'000};
      writer.writeImu(now, {now, {9.81, 0.0, 0.0}, {0.0, 0.0, 0.0}});
      const int rows = i == 20 ? 478 : 480;
      if (i % 10 == 0)
        writer.writeImage(topic::kCamera0, now, now, cv::Mat::ones(rows, 752, CV_8U));
    }
    writer.finish();
  }
  const Outcome outcome =
      run(std::string(kConfig) + " " + bag.string() + " --out " + path("out").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "refused       1 of 6 images")) << outcome.output;
  EXPECT_TRUE(contains(textOf(path("out/events.csv")), "image_refused"));
  EXPECT_TRUE(contains(textOf(path("out/events.csv")), "752x478"));
}

TEST_F(RunBag, DamageIsToldByTheExitCodeAndCountsAgainstAllImages) {
  const std::string bag = writeBag("a.bag");
  {
    std::fstream bytes(bag, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(bag) / 2));
    bytes << std::string(500'000, 'x');
  }
  const Outcome outcome = run(std::string(kConfig) + " " + bag + " --out " + path("out").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "damage        " + bag)) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "6 images, 51 IMU samples")) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, " of 6 images, path")) << outcome.output;
}

TEST_F(RunBag, AnImuThatEndsIsToldByTheExitCode) {
  const fs::path bag = path("ends.bag");
  {
    BagWriter writer(bag.string());
    for (int i = 0; i <= 300; ++i) {
      const Stamp now = 1'600'000'000'000'000'000 + i * Stamp{5'000'000};
      if (i <= 150) writer.writeImu(now, {now, {9.81, 0.0, 0.0}, {0.0, 0.0, 0.0}});
      if (i % 10 == 0) writer.writeImage(topic::kCamera0, now, now, cv::Mat::ones(480, 752, CV_8U));
    }
    writer.finish();
  }
  const Outcome outcome =
      run(std::string(kConfig) + " " + bag.string() + " --out " + path("out").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "IMU           ended at second 0.75")) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, " of 31 images, path")) << outcome.output;
}

TEST_F(RunBag, AFolderThatCannotBeMadeIsAnError) {
  const std::string bag = writeBag("a.bag");
  const Outcome outcome = run(std::string(kConfig) + " " + bag + " --out " + bag);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.output, "a.bag: cannot be made")) << outcome.output;
}

TEST_F(RunBag, AMapWithoutKeyframesIsNotWritten) {
  const std::string bag = writeBag("short.bag");
  const Outcome outcome = run(std::string(kConfig) + " " + bag + " --out " + path("out").string() +
                              " --save-map " + path("a.map").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "saved map     none: there was no keyframe"))
      << outcome.output;
  EXPECT_FALSE(fs::exists(path("a.map")));
}

TEST_F(RunBag, HelpNamesExitCodes) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(contains(outcome.output, "Exit code: 0")) << outcome.output;
}

TEST_F(RunBag, TwoRunsGiveTheSameBytes) {
  const std::string flight = vins::testing::sharedData("euroc_mh01_flight");
  VINS_SKIP_WITHOUT(flight);
  const std::string arguments = std::string(kConfig) + " " + flight + " --duration 8 --out ";
  const Outcome first = run(arguments + path("first").string());
  const Outcome second = run(arguments + path("second").string());
  EXPECT_EQ(first.exit_code, second.exit_code) << first.output;
  EXPECT_EQ(textOf(path("first/vio_live.txt")), textOf(path("second/vio_live.txt")));
  for (const char* name : {"events.csv", "tracker.csv", "estimator.csv"}) {
    EXPECT_EQ(textOf(path("first") / name), textOf(path("second") / name)) << name;
  }
}

TEST_F(RunBag, AnInterruptedRunWritesWhatItHas) {
  const std::string flight = vins::testing::sharedData("euroc_mh01_flight");
  VINS_SKIP_WITHOUT(flight);
  const Outcome outcome =
      run(std::string(kConfig) + " " + flight + " --out " + path("out").string(), "10 %");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "when interrupted")) << outcome.output;
  EXPECT_TRUE(fs::exists(path("out/timing.json")));
  EXPECT_TRUE(fs::exists(path("out/vio_live.txt")));
}

}  // namespace
}  // namespace vins::pipeline
