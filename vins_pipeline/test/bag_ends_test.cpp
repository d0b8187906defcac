// Bags as people bring them: killed, cut, damaged, compressed, split.

#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"
#include "vins_pipeline/bag_recording.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

constexpr Stamp kMs = 1'000'000;
constexpr Stamp kStart = 1'600'000'000'000 * kMs;
constexpr std::uint32_t kRows = 48, kColumns = 64;

sensor_msgs::Image imageAt(int index) {
  sensor_msgs::Image image;
  image.height = kRows;
  image.width = kColumns;
  image.step = kColumns;
  image.encoding = "mono8";
  image.data.resize(kRows * kColumns);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>((i * i + static_cast<std::size_t>(index)) % 251);
  }
  return image;
}

/// Writes messages of every 10 ms, from `begin` on: IMU, and an image at each tenth.
void write(rosbag::Bag* bag, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    const ros::Time now = vins_msgs::toRosTime(kStart + i * 10 * kMs);
    sensor_msgs::Imu imu;
    imu.header.stamp = now;
    imu.linear_acceleration.x = i;
    bag->write("/imu0", now, imu);
    if (i % 10 != 0) continue;
    sensor_msgs::Image image = imageAt(i);
    image.header.stamp = now;
    bag->write("/cam0/image_raw", now, image);
  }
}

/// What of a recording can be used.
struct Contents {
  int images = 0;
  std::vector<double> imu;  ///< each sample's number
};

Contents readAll(Recording* recording) {
  Contents contents;
  while (const auto record = recording->next()) {
    if (const auto* sample = std::get_if<ImuSample>(&record->data)) {
      contents.imu.push_back(sample->acceleration.x());
    }
    if (const auto* image = std::get_if<RecordedImage>(&record->data)) {
      const sensor_msgs::Image expected = imageAt(10 * contents.images);
      const cv::Mat found = image->load();
      EXPECT_TRUE(std::equal(found.datastart, found.dataend, expected.data.begin()));
      ++contents.images;
    }
  }
  for (std::size_t i = 0; i < contents.imu.size(); ++i) {
    EXPECT_EQ(contents.imu[i], static_cast<double>(i));
  }
  return contents;
}

class BagEnds : public ::testing::TestWithParam<rosbag::compression::CompressionType> {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void open(rosbag::Bag* bag, const std::string& name) const {
    bag->open(path(name), rosbag::bagmode::Write);
    bag->setCompression(GetParam());
    bag->setChunkThreshold(20'000);
  }

  /// Two seconds, closed.
  std::string writeWhole(const std::string& name) const {
    rosbag::Bag bag;
    open(&bag, name);
    write(&bag, 0, 200);
    bag.close();
    return path(name);
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / "bag_ends_test";
};

TEST_P(BagEnds, AWholeBagIsReadWhole) {
  const auto recording = openRecording({writeWhole("a.bag")}, {});
  EXPECT_EQ(recording->summary().damage, "");
  EXPECT_EQ(recording->summary().interruption, "");
  EXPECT_EQ(recording->summary().images, 20u);
  const Contents contents = readAll(recording.get());
  EXPECT_EQ(contents.imu.size(), 200u);
  EXPECT_EQ(contents.images, 20);
}

TEST_P(BagEnds, AKilledRecordingIsReadToItsEndAndLeftAsItIs) {
  rosbag::Bag bag;
  open(&bag, "growing.bag");
  write(&bag, 0, 200);
  // What a recorder leaves that is killed now.
  fs::copy_file(path("growing.bag"), path("a.bag.active"));
  bag.close();
  const auto size = fs::file_size(path("a.bag.active"));
  const auto recording = openRecording({path("a.bag.active")}, {});
  const RecordingSummary& summary = recording->summary();
  EXPECT_EQ(summary.damage, "");
  EXPECT_NE(summary.interruption.find("a.bag.active: was not closed"), std::string::npos);
  EXPECT_NE(summary.interruption.find("second 1."), std::string::npos) << summary.interruption;
  const Contents contents = readAll(recording.get());
  EXPECT_EQ(contents.imu.size(), summary.imu_samples);
  EXPECT_EQ(static_cast<std::size_t>(contents.images), summary.images);
  // At most a chunk and the recorder's own buffer are lost.
  EXPECT_GE(summary.imu_samples, 130u);
  EXPECT_EQ(fs::file_size(path("a.bag.active")), size);
}

TEST_P(BagEnds, ACutFileIsReadAsFarAsItGoes) {
  const std::string file = writeWhole("a.bag");
  fs::resize_file(file, fs::file_size(file) / 2);
  const auto recording = openRecording({file}, {});
  const RecordingSummary& summary = recording->summary();
  EXPECT_NE(summary.damage.find("is damaged behind second "), std::string::npos) << summary.damage;
  const Contents contents = readAll(recording.get());
  EXPECT_GT(contents.images, 5);
  EXPECT_LT(contents.images, 20);
  EXPECT_EQ(contents.imu.size(), summary.imu_samples);
}

TEST_P(BagEnds, DamageInTheMiddleCountsAgainstAllImages) {
  const std::string file = writeWhole("a.bag");
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
    const std::string rubbish(6'000, '\xff');
    bytes.write(rubbish.data(), static_cast<std::streamsize>(rubbish.size()));
  }
  const auto recording = openRecording({file}, {});
  const RecordingSummary& summary = recording->summary();
  EXPECT_NE(summary.damage.find("is damaged behind second "), std::string::npos) << summary.damage;
  EXPECT_EQ(summary.images, 20u);
  EXPECT_EQ(summary.imu_samples, 200u);
  const Contents contents = readAll(recording.get());
  EXPECT_GT(contents.images, 2);
  EXPECT_LT(contents.images, 15);
}

TEST_P(BagEnds, TheBagsOfASplitRecordingAreOneInAnyOrder) {
  const int ends[] = {0, 70, 140, 200};
  for (int i = 0; i < 3; ++i) {
    rosbag::Bag bag;
    open(&bag, "a_" + std::to_string(i) + ".bag");
    write(&bag, ends[i], ends[i + 1]);
    bag.close();
  }
  const auto recording = openRecording({path("a_0.bag"), path("a_2.bag"), path("a_1.bag")}, {});
  EXPECT_EQ(recording->summary().name, path("a_0.bag") + " and 2 more");
  EXPECT_EQ(recording->summary().images, 20u);
  const Contents contents = readAll(recording.get());
  EXPECT_EQ(contents.imu.size(), 200u);
  EXPECT_EQ(contents.images, 20);
  EXPECT_THROW(openRecording({path("a_0.bag"), path("a_0.bag")}, {}), InputError);
  EXPECT_THROW(openRecording({path("a_0.bag"), folder_.string()}, {}), InputError);
}

/// Whatever is left of a bag, reading ends without a fault.
TEST_P(BagEnds, EveryCutIsSurvived) {
  const std::string file = writeWhole("a.bag");
  for (std::uintmax_t size = fs::file_size(file); size > 700; size -= 700) {
    fs::resize_file(file, size);
    try {
      const auto recording = openRecording({file}, {});
      EXPECT_LE(readAll(recording.get()).imu.size(), 200u);
    } catch (const InputError&) {
      EXPECT_LT(size, 20'000u) << "there are messages to read";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagEnds,
                         ::testing::Values(rosbag::compression::Uncompressed,
                                           rosbag::compression::BZ2, rosbag::compression::LZ4));

}  // namespace
}  // namespace vins::pipeline
