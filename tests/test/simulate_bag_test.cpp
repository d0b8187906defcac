// The simulator, run as a user runs it.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sys/wait.h>

#include "camera_model/camera_file.h"
#include "vins_core/parameters.h"
#include "vins_core/testing/shared_data.h"
#include "vins_core/trajectory_file.h"
#include "vins_pipeline/asl_folder.h"

namespace fs = std::filesystem;

namespace vins::tests {
namespace {

const fs::path kFolder = fs::path(::testing::TempDir()) / "simulate_bag_test";

struct Outcome {
  int exit_code = 0;
  std::string output;
};

/// Runs the tool; `name` is the bag's, in a folder of the test's own.
Outcome simulate(const std::string& name, const std::string& arguments) {
  fs::create_directories(kFolder);
  const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "simulate_bag";
  const fs::path log = kFolder / "log.txt";
  const std::string command = tool.string() + " -o " + (kFolder / name).string() + " " + arguments +
                              " > " + log.string() + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream in(log);
  return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(in), {})};
}

std::string bytesOf(const std::string& name) {
  std::ifstream in(kFolder / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

template <typename Message>
std::vector<Message> messagesOf(const std::string& name, const std::string& topic) {
  rosbag::Bag bag((kFolder / name).string(), rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  std::vector<Message> messages;
  for (const rosbag::MessageInstance& instance : view) {
    messages.push_back(*instance.instantiate<Message>());
  }
  return messages;
}

class SimulateBag : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(kFolder); }
};

TEST_F(SimulateBag, TheSameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  const std::string options = "--trajectory hover --duration 1 --rate 5 ";
  ASSERT_EQ(simulate("a.bag", options + "--threads 1").exit_code, 0);
  ASSERT_EQ(simulate("b.bag", options + "--threads 2").exit_code, 0);
  ASSERT_EQ(simulate("c.bag", options + "--seed 2").exit_code, 0);
  EXPECT_EQ(bytesOf("a.bag"), bytesOf("b.bag"));
  EXPECT_EQ(bytesOf("a_groundtruth.txt"), bytesOf("b_groundtruth.txt"));
  EXPECT_NE(bytesOf("a.bag"), bytesOf("c.bag"));
}

TEST_F(SimulateBag, WritesTopicsPosesAndRig) {
  const Outcome outcome = simulate(
      "s.bag", "--trajectory hover --duration 1 --rate 5 --stereo --td 0.01 --calibration-error 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto left = messagesOf<sensor_msgs::Image>("s.bag", "/cam0/image_raw");
  const auto right = messagesOf<sensor_msgs::Image>("s.bag", "/cam1/image_raw");
  ASSERT_EQ(left.size(), 6u);
  ASSERT_EQ(right.size(), 6u);
  EXPECT_EQ(left[1].header.stamp.toNSec(), 1600000000200000000u);
  EXPECT_NE(left[1].data, right[1].data);
  // Up to 30 ms after the last image: td and the overhang.
  EXPECT_EQ(messagesOf<sensor_msgs::Imu>("s.bag", "/imu0").size(), 207u);
  const Trajectory poses = readTrajectoryFile((kFolder / "s_groundtruth.txt").string());
  EXPECT_EQ(poses.poses().size(), 201u);
  const Parameters rig = Parameters::load((kFolder / "s_rig.yaml").string());
  const Parameters truth = Parameters::load((kFolder / "s_true_rig.yaml").string());
  EXPECT_EQ(rig.number("td"), 0.0);
  EXPECT_TRUE(rig.flag("estimate_td"));
  EXPECT_EQ(truth.number("td"), 0.01);
  EXPECT_NE(camera_model::readCamera(rig)->parameters(),
            camera_model::readCamera(truth)->parameters());
  EXPECT_TRUE(fs::exists(kFolder / "s_rig_cam1.yaml"));
  EXPECT_TRUE(fs::exists(kFolder / "s_imu_biases.txt"));
}

TEST_F(SimulateBag, FaultsAreInTheBag) {
  const Outcome outcome =
      simulate("f.bag",
               "--trajectory still --duration 2 --rate 10 --blackout 1:0.5 --drop-frames 0.5:0.2 "
               "--imu-gap 0.2:0.1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto images = messagesOf<sensor_msgs::Image>("f.bag", "/cam0/image_raw");
  ASSERT_EQ(images.size(), 19u);
  for (const sensor_msgs::Image& image : images) {
    const double t = image.header.stamp.toSec() - 1600000000.0;
    double sum = 0.0;
    for (const std::uint8_t gray : image.data) sum += gray;
    const bool is_black = sum / static_cast<double>(image.data.size()) < 3.0;
    EXPECT_EQ(is_black, t > 0.95 && t < 1.45) << t;
  }
  EXPECT_EQ(messagesOf<sensor_msgs::Imu>("f.bag", "/imu0").size(), 405u - 19u);
}

TEST_F(SimulateBag, RecordedImuIsTakenAsItIs) {
  const std::string poses = vins::testing::sharedData("groundtruth/V2_01_easy.txt");
  const std::string imu = vins::testing::sharedData("recorded_imu/V2_01_easy.csv");
  VINS_SKIP_WITHOUT(imu);
  const Outcome outcome = simulate("r.bag", "--trajectory " + poses + " --recorded-imu " + imu +
                                                " --start 20 --duration 1 --rate 5");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  std::map<Stamp, ImuSample> recorded;
  for (const ImuSample& sample : pipeline::readImuCsv(imu)) recorded[sample.stamp] = sample;
  const auto messages = messagesOf<sensor_msgs::Imu>("r.bag", "/imu0");
  EXPECT_NEAR(static_cast<double>(messages.size()), 204.0, 1.0);
  for (const sensor_msgs::Imu& message : messages) {
    const ImuSample& sample = recorded.at(static_cast<Stamp>(message.header.stamp.toNSec()));
    EXPECT_EQ(message.linear_acceleration.x, sample.acceleration.x());
    EXPECT_EQ(message.angular_velocity.z, sample.angular_velocity.z());
  }
  EXPECT_FALSE(fs::exists(kFolder / "r_imu_biases.txt"));
}

TEST_F(SimulateBag, ErrorsTellWhatIsAllowed) {
  const struct {
    std::string arguments;
    std::string expected;
  } cases[] = {
      {"--trajectory loop", "found 'loop'; allowed: a file, hall_loop"},
      {"--scene cave", "found 'cave'; allowed: room"},
      {"--imu-noise much", "found 'much'; allowed: euroc, low, none"},
      {"--blackout 5", "--blackout: found '5'; allowed: START:DURATION"},
      {"--duration 0", "duration: found 0; allowed"},
      {"--duration 10 --faults", "--faults: found a duration of 10"},
      {"--recorded-imu /no/such.csv", "/no/such.csv: cannot be opened"},
      {"--camera /no/such.yaml", "/no/such.yaml"},
      {"--td 1", "td: found 1; allowed: -0.2 to 0.2 s"},
      {"--calibration-error -1", "allowed: a number of sigmas"},
      {"--preset kitchen", "--preset: found 'kitchen'; allowed: household"},
      {"--preset household --td 0.1", "--preset household: found --td; allowed: --seed"},
      {"--speed 2", "unrecognised option '--speed'"},
  };
  for (const auto& c : cases) {
    const Outcome outcome = simulate("e.bag", c.arguments);
    EXPECT_EQ(outcome.exit_code, 1) << c.arguments;
    EXPECT_NE(outcome.output.find(c.expected), std::string::npos) << outcome.output;
    EXPECT_FALSE(fs::exists(kFolder / "e.bag"));
  }
  EXPECT_EQ(simulate("h.bag", "--help").exit_code, 0);
}

}  // namespace
}  // namespace vins::tests
