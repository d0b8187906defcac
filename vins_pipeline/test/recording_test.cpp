// Bags and folders as streams of messages.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/input_error.h"
#include "vins_core/testing/shared_data.h"
#include "vins_msgs/conversions.h"
#include "vins_pipeline/bag_recording.h"
#include "vins_pipeline/bag_writer.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

constexpr Stamp kMs = 1'000'000;
constexpr Stamp kStart = 1'600'000'000'000 * kMs;

class RecordingTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_ = fs::path(::testing::TempDir()) / "recording_test";
};

cv::Mat greyImage() {
  cv::Mat image(24, 32, CV_8UC1);
  for (int i = 0; i < 24 * 32; ++i) image.data[i] = static_cast<std::uint8_t>(i % 200);
  return image;
}

/// Two seconds: IMU at 200 Hz, images at 10 Hz that arrive 7 ms late, truth at 20 Hz.
void writeBag(const std::string& path) {
  BagWriter bag(path);
  for (int i = 0; i <= 400; ++i) {
    const Stamp now = kStart + i * 5 * kMs;
    bag.writeImu(now, {now, {0.0, 0.0, 9.81}, {0.001 * i, 0.0, 0.0}});
    if (i % 10 == 0) bag.writeGroundTruth(now, now, {});
    if (i % 20 == 2) bag.writeImage(topic::kCamera0, now, now - 7 * kMs, greyImage());
  }
  bag.finish();
}

struct Contents {
  std::vector<ImuSample> imu;
  std::vector<RecordedImage> images;
  std::vector<RecordedTruth> truth;
};

Contents readAll(Recording* recording) {
  Contents contents;
  Stamp before = 0;
  while (const auto record = recording->next()) {
    const Stamp stamp = std::visit([](const auto& data) { return data.stamp; }, record->data);
    EXPECT_GE(stamp, before);
    before = stamp;
    if (const auto* sample = std::get_if<ImuSample>(&record->data)) contents.imu.push_back(*sample);
    if (const auto* image = std::get_if<RecordedImage>(&record->data)) {
      contents.images.push_back(*image);
    }
    if (const auto* truth = std::get_if<RecordedTruth>(&record->data)) {
      contents.truth.push_back(*truth);
    }
  }
  EXPECT_FALSE(recording->next());
  return contents;
}

std::string messageOf(const std::string& path, const RecordingSelection& selection) {
  try {
    openRecording({path}, selection);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(RecordingTest, ABagIsReadInTheOrderOfItsStamps) {
  writeBag(path("a.bag"));
  const auto recording = openRecording({path("a.bag")}, {});
  const RecordingSummary& summary = recording->summary();
  EXPECT_EQ(summary.imu_samples, 401u);
  EXPECT_EQ(summary.images, 20u);
  EXPECT_EQ(summary.truth_poses, 41u);
  EXPECT_EQ(summary.truth_source, path("a.bag") + ":/ground_truth/pose");
  EXPECT_NEAR(summary.duration(), 2.0, 1e-9);
  const Contents contents = readAll(recording.get());
  EXPECT_EQ(contents.imu.size(), 401u);
  EXPECT_EQ(contents.truth.size(), 41u);
  ASSERT_EQ(contents.images.size(), 20u);
  EXPECT_EQ(contents.images[3].stamp, kStart + 303 * kMs) << "of the header, not of the arrival";
  EXPECT_EQ(contents.imu[7].angular_velocity.x(), 0.007);
  // Decoded when asked for, also later and twice.
  EXPECT_EQ(cv::norm(contents.images[0].load(), greyImage(), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(contents.images[0].load(), contents.images[9].load(), cv::NORM_INF), 0.0);
}

TEST_F(RecordingTest, AnAccelerometerMayHaveATopicOfItsOwn) {
  writeBag(path("parted.bag"));
  {
    rosbag::Bag bag(path("parted.bag"), rosbag::bagmode::Append);
    for (int i = 0; i <= 125; ++i) {
      sensor_msgs::Imu message;
      message.header.stamp = vins_msgs::toRosTime(kStart + i * 16 * kMs);
      message.linear_acceleration.x = i;
      bag.write("/accel", message.header.stamp, message);
    }
  }
  RecordingSelection selection;
  selection.accel_topic = "/accel";
  const auto recording = openRecording({path("parted.bag")}, selection);
  EXPECT_EQ(recording->summary().imu_samples, 401u) << "the gyroscope's";
  std::vector<RecordedAcceleration> readings;
  Stamp before = 0;
  while (const auto record = recording->next()) {
    const Stamp stamp = std::visit([](const auto& data) { return data.stamp; }, record->data);
    EXPECT_GE(stamp, before);
    before = stamp;
    const auto* reading = std::get_if<RecordedAcceleration>(&record->data);
    if (reading != nullptr) readings.push_back(*reading);
  }
  ASSERT_EQ(readings.size(), 126u);
  EXPECT_EQ(readings[10].stamp, kStart + 160 * kMs);
  EXPECT_EQ(readings[10].acceleration.x(), 10.0);
  selection.accel_topic = "/nobody";
  EXPECT_TRUE(contains(messageOf(path("parted.bag"), selection), "has no topic '/nobody'"));
}

TEST_F(RecordingTest, ASpanIsCutOut) {
  writeBag(path("a.bag"));
  RecordingSelection selection;
  selection.start = 0.5;
  selection.duration = 1.0;
  const auto recording = openRecording({path("a.bag")}, selection);
  EXPECT_EQ(recording->summary().begin, kStart + 500 * kMs);
  const Contents contents = readAll(recording.get());
  EXPECT_EQ(contents.imu.size(), 201u);
  EXPECT_EQ(contents.imu.size(), recording->summary().imu_samples);
  EXPECT_EQ(contents.images.size(), recording->summary().images);
  EXPECT_EQ(contents.truth.size(), recording->summary().truth_poses);
  EXPECT_EQ(contents.imu.front().stamp, kStart + 500 * kMs);
  EXPECT_EQ(contents.imu.back().stamp, kStart + 1500 * kMs);
}

sensor_msgs::Image imageMessage(const std::string& encoding, int type, const cv::Scalar& value) {
  const cv::Mat image(24, 32, type, value);
  sensor_msgs::Image message;
  message.header.stamp = vins_msgs::toRosTime(kStart);
  message.height = 24;
  message.width = 32;
  message.encoding = encoding;
  message.step = static_cast<std::uint32_t>(image.step);
  message.data.assign(image.datastart, image.dataend);
  return message;
}

/// The grey value that an image of one colour becomes.
double greyOf(const std::string& path, const sensor_msgs::Image& message) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  sensor_msgs::Imu imu;
  imu.header.stamp = message.header.stamp;
  bag.write("/imu0", message.header.stamp, imu);
  bag.write("/cam0/image_raw", message.header.stamp, message);
  bag.close();
  const auto recording = openRecording({path}, {});
  const cv::Mat image = readAll(recording.get()).images.at(0).load();
  EXPECT_EQ(image.type(), CV_8UC1);
  EXPECT_EQ(image.size(), cv::Size(32, 24));
  return cv::mean(image)[0];
}

TEST_F(RecordingTest, ColourBayerAndDeepImagesBecomeGrey) {
  const std::string bag = path("c.bag");
  EXPECT_EQ(greyOf(bag, imageMessage("mono8", CV_8UC1, 77)), 77.0);
  EXPECT_EQ(greyOf(bag, imageMessage("8UC1", CV_8UC1, 77)), 77.0);
  EXPECT_NEAR(greyOf(bag, imageMessage("mono16", CV_16UC1, 77 * 257)), 77.0, 1.0);
  EXPECT_NEAR(greyOf(bag, imageMessage("16UC1", CV_16UC1, 77 * 257)), 77.0, 1.0);
  EXPECT_NEAR(greyOf(bag, imageMessage("bgr8", CV_8UC3, {0, 0, 200})), 0.299 * 200, 1.0);
  EXPECT_NEAR(greyOf(bag, imageMessage("rgb8", CV_8UC3, {200, 0, 0})), 0.299 * 200, 1.0);
  EXPECT_NEAR(greyOf(bag, imageMessage("bayer_rggb8", CV_8UC1, 77)), 77.0, 1.0);
}

TEST_F(RecordingTest, UnknownEncodingsAreNamed) {
  try {
    greyOf(path("e.bag"), imageMessage("thermal9", CV_8UC1, 1));
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(contains(message, "e.bag: /cam0/image_raw: image at 1600000000000000000 ns"));
    EXPECT_TRUE(contains(message, "32x24 'thermal9'")) << message;
  }
}

TEST_F(RecordingTest, CompressedImagesAndLaserTrackersAreRead) {
  {
    rosbag::Bag bag(path("z.bag"), rosbag::bagmode::Write);
    const ros::Time now = vins_msgs::toRosTime(kStart);
    sensor_msgs::CompressedImage image;
    image.header.stamp = now;
    image.format = "png";
    cv::imencode(".png", greyImage(), image.data);
    bag.write("/camera/compressed", now, image);
    image.data.resize(10);
    bag.write("/camera/compressed", now, image);
    sensor_msgs::Imu imu;
    imu.header.stamp = now;
    bag.write("/my_imu", now, imu);
    geometry_msgs::PointStamped point;
    point.header.stamp = now;
    point.point.y = 2.0;
    bag.write("/leica/position", now, point);
    bag.close();
  }
  RecordingSelection selection;
  selection.imu_topic = "/my_imu";
  selection.image_topics = {"/camera/compressed"};
  const auto recording = openRecording({path("z.bag")}, selection);
  const Contents contents = readAll(recording.get());
  ASSERT_EQ(contents.images.size(), 2u);
  EXPECT_EQ(cv::norm(contents.images[0].load(), greyImage(), cv::NORM_INF), 0.0);
  EXPECT_THROW(contents.images[1].load(), InputError);
  ASSERT_EQ(contents.truth.size(), 1u);
  EXPECT_FALSE(contents.truth[0].has_rotation);
  EXPECT_EQ(contents.truth[0].T_wb.position.y(), 2.0);
}

/// A second of IMU samples, and images that arrive only when all samples have come.
TEST_F(RecordingTest, LateImagesAreReadAtTheirStamps) {
  {
    BagWriter bag(path("late.bag"));
    for (int i = 0; i < 200; ++i) {
      const Stamp now = kStart + i * 5 * kMs;
      bag.writeImu(now, {now, {0.0, 0.0, 9.81}, {0.0, 0.0, 0.0}});
    }
    for (const int ms : {100, 300, 200}) {
      bag.writeImage(topic::kCamera0, kStart + 1000 * kMs, kStart + ms * kMs, greyImage());
    }
    bag.finish();
  }
  const Contents contents = readAll(openRecording({path("late.bag")}, {}).get());
  EXPECT_EQ(contents.imu.size(), 200u);
  ASSERT_EQ(contents.images.size(), 3u);
  EXPECT_EQ(contents.images[1].stamp, kStart + 200 * kMs);
}

TEST_F(RecordingTest, TheCompressedTopicIsFoundByTheBaseName) {
  {
    rosbag::Bag bag(path("compressed.bag"), rosbag::bagmode::Write);
    const ros::Time now = vins_msgs::toRosTime(kStart);
    sensor_msgs::CompressedImage image;
    image.header.stamp = now;
    cv::imencode(".png", greyImage(), image.data);
    bag.write("/cam0/image_raw/compressed", now, image);
    sensor_msgs::Imu imu;
    imu.header.stamp = now;
    bag.write("/imu0", now, imu);
    bag.close();
  }
  const auto recording = openRecording({path("compressed.bag")}, {});
  EXPECT_EQ(recording->summary().images, 1u);
  const Contents contents = readAll(recording.get());
  ASSERT_EQ(contents.images.size(), 1u);
  EXPECT_EQ(cv::norm(contents.images[0].load(), greyImage(), cv::NORM_INF), 0.0);
}

TEST_F(RecordingTest, ErrorsTellWhatIsThere) {
  writeBag(path("a.bag"));
  RecordingSelection selection;
  selection.imu_topic = "/imu";
  std::string message = messageOf(path("a.bag"), selection);
  EXPECT_TRUE(contains(message,
                       "a.bag: has no topic '/imu'; it has /cam0/image_raw "
                       "(sensor_msgs/Image), /ground_truth/pose "))
      << message;
  selection = {};
  selection.image_topics = {"/imu0"};
  message = messageOf(path("a.bag"), selection);
  EXPECT_TRUE(contains(message, "topic '/imu0' is of type sensor_msgs/Imu")) << message;
  selection = {};
  selection.start = 5.0;
  message = messageOf(path("a.bag"), selection);
  EXPECT_TRUE(contains(message, "nothing from second 5 on; it is 2 s long")) << message;
  selection.start = -1.0;
  EXPECT_TRUE(contains(messageOf(path("a.bag"), selection), "start: found -1"));
  EXPECT_TRUE(contains(messageOf(path("none.bag"), {}), "none.bag: is not there"));
}

TEST_F(RecordingTest, BrokenBagsAreNamed) {
  std::ofstream(path("text.bag")) << "this is no bag";
  EXPECT_TRUE(contains(messageOf(path("text.bag"), {}), "text.bag: cannot be read as a bag"));
  std::ofstream(path("empty.bag"));
  EXPECT_TRUE(contains(messageOf(path("empty.bag"), {}), "empty.bag: cannot be read as a bag"));
}

TEST_F(RecordingTest, AnAslFolderIsTheSameStream) {
  const std::string folder = vins::testing::sharedData("euroc_v101_micro");
  VINS_SKIP_WITHOUT(folder);
  RecordingSelection selection;
  selection.start = 1.0;
  selection.duration = 2.0;
  selection.image_topics = {"/cam0/image_raw", "/cam1/image_raw"};
  const auto recording = openRecording({folder}, selection);
  const RecordingSummary& summary = recording->summary();
  EXPECT_NEAR(summary.duration(), 2.0, 0.01);
  const Contents contents = readAll(recording.get());
  EXPECT_EQ(contents.imu.size(), summary.imu_samples);
  EXPECT_NEAR(static_cast<double>(contents.imu.size()), 400.0, 2.0);
  EXPECT_EQ(contents.images.size(), summary.images);
  EXPECT_NEAR(static_cast<double>(contents.images.size()), 80.0, 4.0);
  EXPECT_GT(contents.truth.size(), 100u);
  EXPECT_EQ(contents.images[0].load().size(), cv::Size(752, 480));
  EXPECT_NE(contents.images[0].camera, contents.images[1].camera);
  selection.image_topics = {"/cam5/image_raw"};
  EXPECT_TRUE(contains(messageOf(folder, selection), "has no cam5 for topic '/cam5/image_raw'"));
}

}  // namespace
}  // namespace vins::pipeline
