#include "vins_pipeline/bag_writer.h"

#include <cstdint>
#include <cstdio>
#include <map>

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/folder.h"
#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"

namespace vins::pipeline {

/// The open bag, and how many messages each topic has.
class BagWriter::Bag {
 public:
  explicit Bag(const std::string& path) : bag(path, rosbag::bagmode::Write) {}

  rosbag::Bag bag;
  std::map<std::string, std::uint32_t> counts;
};

BagWriter::BagWriter(const std::string& path) : path_(path) {
  makeFolderOf(path_);
  try {
    bag_ = std::make_unique<Bag>(path_ + ".part");
  } catch (const rosbag::BagException& error) {
    std::remove((path_ + ".part").c_str());
    throw InputError(path_ + ": cannot be written: " + error.what());
  }
}

BagWriter::~BagWriter() {
  if (!bag_) return;
  try {
    bag_->bag.close();
  } catch (const rosbag::BagException&) {
    // On a full disk. rosbag's destructor would close it once more, throw, and end the program.
    static_cast<void>(bag_.release());
  }
  std::remove((path_ + ".part").c_str());
}

template <typename Message>
void BagWriter::write(const std::string& topic, Stamp recorded, Message* message, Stamp stamp,
                      const std::string& frame) {
  try {
    message->header.seq = bag_->counts[topic]++;
    message->header.stamp = vins_msgs::toRosTime(stamp);
    message->header.frame_id = frame;
    bag_->bag.write(topic, vins_msgs::toRosTime(recorded), *message);
  } catch (const rosbag::BagException& error) {
    throw InputError(path_ + ": cannot be written: " + error.what());
  } catch (const InputError& error) {
    throw InputError(path_ + ": " + topic + ": " + error.what());
  }
}

void BagWriter::writeImage(const std::string& topic, Stamp recorded, Stamp stamp,
                           const cv::Mat& image) {
  if (image.empty() || image.type() != CV_8UC1) {
    throw InputError(path_ + ": " + topic + ": image at " + std::to_string(stamp) +
                     " ns is empty or not of one channel of 8 bits");
  }
  sensor_msgs::Image message;
  message.height = static_cast<std::uint32_t>(image.rows);
  message.width = static_cast<std::uint32_t>(image.cols);
  message.encoding = "mono8";
  message.step = message.width;
  message.data.reserve(image.total());
  for (int row = 0; row < image.rows; ++row) {
    message.data.insert(message.data.end(), image.ptr(row), image.ptr(row) + image.cols);
  }
  write(topic, recorded, &message, stamp, topic == topic::kCamera1 ? "cam1" : "cam0");
}

void BagWriter::writeImu(Stamp recorded, const ImuSample& sample) {
  sensor_msgs::Imu message = vins_msgs::toMsg(sample);
  write(topic::kImu, recorded, &message, sample.stamp, "imu0");
}

void BagWriter::writeGroundTruth(Stamp recorded, Stamp stamp, const Pose& T_wb) {
  geometry_msgs::PoseStamped message;
  message.pose = vins_msgs::toMsg(T_wb);
  write(topic::kGroundTruth, recorded, &message, stamp, "world");
}

void BagWriter::finish() {
  try {
    bag_->bag.close();
  } catch (const rosbag::BagException& error) {
    throw InputError(path_ + ": cannot be written: " + error.what());
  }
  const std::string aside = path_ + ".part";
  if (std::rename(aside.c_str(), path_.c_str()) != 0) {
    throw InputError(path_ + ": cannot be written");
  }
  bag_.reset();
}

}  // namespace vins::pipeline
