// The converter, run as a user runs it, on real recordings.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sys/wait.h>

#include "vins_core/testing/shared_data.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

struct Outcome {
  int exit_code = 0;
  std::string output;
};

Outcome convert(const std::string& arguments) {
  const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "asl_to_bag";
  const fs::path log = fs::path(::testing::TempDir()) / "asl_to_bag_test.log";
  const int status =
      std::system((tool.string() + " " + arguments + " > " + log.string() + " 2>&1").c_str());
  std::ifstream in(log);
  return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(in), {})};
}

/// What a topic, or a csv file, holds.
struct Content {
  std::uint64_t count = 0, first = 0, last = 0;

  void add(std::uint64_t stamp) {
    if (count++ == 0) first = stamp;
    last = stamp;
  }
  bool operator==(const Content& other) const {
    return count == other.count && first == other.first && last == other.last;
  }
};

std::ostream& operator<<(std::ostream& out, const Content& content) {
  return out << content.count << " from " << content.first << " to " << content.last;
}

Content contentOfCsv(const std::string& path) {
  Content content;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line[0] != '#') content.add(std::stoull(line));
  }
  return content;
}

/// The same for the images that are there; they are named by their stamps.
Content contentOfImages(const std::string& camera) {
  Content content;
  std::ifstream in(camera + "/data.csv");
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::string stamp = line.substr(0, line.find(','));
    if (fs::exists(camera + "/data/" + stamp + ".png")) content.add(std::stoull(stamp));
  }
  return content;
}

ros::Time stampOf(const rosbag::MessageInstance& message) {
  if (const auto image = message.instantiate<sensor_msgs::Image>()) return image->header.stamp;
  if (const auto imu = message.instantiate<sensor_msgs::Imu>()) return imu->header.stamp;
  return message.instantiate<geometry_msgs::PoseStamped>()->header.stamp;
}

/// Per topic, by the stamps in the headers, which are also the times of arrival.
std::map<std::string, Content> contentOfBag(const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag);
  std::map<std::string, Content> contents;
  ros::Time before(0.0);
  for (const rosbag::MessageInstance& message : view) {
    EXPECT_LE(before, message.getTime());
    before = message.getTime();
    contents[message.getTopic()].add(stampOf(message).toNSec());
    EXPECT_EQ(stampOf(message), message.getTime());
  }
  return contents;
}

class RealRecording : public ::testing::TestWithParam<const char*> {};

TEST_P(RealRecording, BecomesABagWithTheSameCountsAndStamps) {
  const std::string folder = vins::testing::sharedData(GetParam());
  VINS_SKIP_WITHOUT(folder);
  const std::string bag = (fs::path(::testing::TempDir()) / GetParam()).string() + ".bag";
  const Outcome outcome = convert(folder + " " + bag + " --skip-missing-images");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string mav = folder + "/mav0/";
  const auto contents = contentOfBag(bag);
  EXPECT_EQ(contents.at("/cam0/image_raw"), contentOfImages(mav + "cam0"));
  EXPECT_EQ(contents.at("/imu0"), contentOfCsv(mav + "imu0/data.csv"));
  EXPECT_EQ(contents.at("/ground_truth/pose"),
            contentOfCsv(mav + "state_groundtruth_estimate0/data.csv"));
  if (fs::exists(mav + "cam1")) {
    EXPECT_EQ(contents.at("/cam1/image_raw"), contentOfImages(mav + "cam1"));
  }
  EXPECT_FALSE(fs::exists(bag + ".part"));
  fs::remove(bag);
}

INSTANTIATE_TEST_SUITE_P(EuRoC, RealRecording,
                         ::testing::Values("euroc_v101_micro", "euroc_mh01_flight"),
                         [](const auto& info) { return std::string(info.param); });

TEST(AslToBag, TellsWhatIsWrongAndLeavesNothingBehind) {
  EXPECT_EQ(convert("--help").exit_code, 0);
  EXPECT_EQ(convert("").exit_code, 1);
  const std::string bag = (fs::path(::testing::TempDir()) / "none.bag").string();
  const Outcome outcome = convert("/no/such/folder " + bag);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("/no/such/folder: is no folder"), std::string::npos)
      << outcome.output;
  EXPECT_FALSE(fs::exists(bag));
  EXPECT_FALSE(fs::exists(bag + ".part"));
}

}  // namespace
}  // namespace vins::pipeline
