#include "vins_pipeline/bag_writer.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/input_error.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

const std::string kPath = (fs::path(::testing::TempDir()) / "bag_writer_test.bag").string();

void writeSmallBag() {
  BagWriter bag(kPath);
  ImuSample sample;
  sample.stamp = 1403636579758555392;
  sample.angular_velocity = {1.0, 2.0, 3.0};
  sample.acceleration = {4.0, 5.0, 6.0};
  bag.writeImu(sample.stamp, sample);
  // A part of a larger image, whose rows do not lie close to each other.
  const cv::Mat large(30, 40, CV_8UC1, cv::Scalar(7));
  bag.writeImage(topic::kCamera0, 1403636579763555584, 1403636579763555584,
                 large(cv::Rect(5, 5, 20, 10)));
  bag.writeGroundTruth(1403636579763555584, 1403636579763555584, Pose());
  bag.finish();
}

std::string bytes() {
  std::ifstream in(kPath, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(BagWriter, WritesWhatCanBeReadAgain) {
  writeSmallBag();
  rosbag::Bag bag(kPath, rosbag::bagmode::Read);
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), 3u);
  auto message = view.begin();
  EXPECT_EQ(message->getTopic(), "/imu0");
  const auto imu = message->instantiate<sensor_msgs::Imu>();
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->header.stamp.toNSec(), 1403636579758555392u);
  EXPECT_EQ(imu->linear_acceleration.z, 6.0);
  rosbag::View images(bag, rosbag::TopicQuery("/cam0/image_raw"));
  ASSERT_EQ(images.size(), 1u);
  message = images.begin();
  const auto image = message->instantiate<sensor_msgs::Image>();
  ASSERT_TRUE(image);
  EXPECT_EQ(message->getTime().toNSec(), 1403636579763555584u);
  EXPECT_EQ(image->encoding, "mono8");
  EXPECT_EQ(image->data, std::vector<std::uint8_t>(200, 7));
  EXPECT_FALSE(fs::exists(kPath + ".part"));
}

TEST(BagWriter, TheSameCallsGiveTheSameBytes) {
  writeSmallBag();
  const std::string first = bytes();
  writeSmallBag();
  EXPECT_EQ(first, bytes());
}

TEST(BagWriter, LeavesNothingBehindUnlessFinished) {
  fs::remove(kPath);
  { BagWriter bag(kPath); }
  EXPECT_FALSE(fs::exists(kPath));
  EXPECT_FALSE(fs::exists(kPath + ".part"));
}

TEST(BagWriter, RefusesBadStampsImagesAndPlaces) {
  BagWriter bag(kPath);
  EXPECT_THROW(bag.writeImu(0, ImuSample()), InputError);
  EXPECT_THROW(bag.writeImage(topic::kCamera0, 1, 1, cv::Mat()), InputError);
  EXPECT_THROW(bag.writeImage(topic::kCamera0, 1, 1, cv::Mat(2, 2, CV_8UC3)), InputError);
  EXPECT_THROW(BagWriter("/dev/null/x.bag"), InputError);
}

}  // namespace
}  // namespace vins::pipeline
