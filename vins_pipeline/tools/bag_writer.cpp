#include "vins_pipeline/bag_writer.h"

#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/input_error.h"

namespace vins {
namespace {

constexpr Stamp kNanoseconds = 1000000000;

ros::Time toRosTime(Stamp stamp) {
  if (stamp < 1 || stamp / kNanoseconds > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("stamp " + std::to_string(stamp) + " ns; allowed: from 1 ns to the year 2106");
  }
  return {static_cast<std::uint32_t>(stamp / kNanoseconds),
          static_cast<std::uint32_t>(stamp % kNanoseconds)};
}

geometry_msgs::Vector3 toMessage(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::Pose toMessage(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.position.x();
  message.position.y = pose.position.y();
  message.position.z = pose.position.z();
  message.orientation.x = pose.rotation.x();
  message.orientation.y = pose.rotation.y();
  message.orientation.z = pose.rotation.z();
  message.orientation.w = pose.rotation.w();
  return message;
}

}  // namespace

/// The open bag, and how many messages each topic has.
class BagWriter::Bag {
 public:
  explicit Bag(const std::string& path) : bag(path, rosbag::bagmode::Write) {}

  rosbag::Bag bag;
  std::map<std::string, std::uint32_t> counts;
};

BagWriter::BagWriter(const std::string& path) : path_(path) {
  try {
    bag_ = std::make_unique<Bag>(path_ + ".part");
  } catch (const rosbag::BagException& error) {
    throw InputError(path_ + ": cannot be written: " + error.what());
  }
}

BagWriter::~BagWriter() {
  if (!bag_) return;
  bag_.reset();
  std::remove((path_ + ".part").c_str());
}

template <typename Message>
void BagWriter::write(const std::string& topic, Stamp recorded, Message* message, Stamp stamp,
                      const std::string& frame) {
  try {
    message->header.seq = bag_->counts[topic]++;
    message->header.stamp = toRosTime(stamp);
    message->header.frame_id = frame;
    bag_->bag.write(topic, toRosTime(recorded), *message);
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
  sensor_msgs::Imu message;
  message.orientation_covariance[0] = -1.0;  // ROS's way to say that there is no orientation
  message.angular_velocity = toMessage(sample.angular_velocity);
  message.linear_acceleration = toMessage(sample.acceleration);
  write(topic::kImu, recorded, &message, sample.stamp, "imu0");
}

void BagWriter::writeGroundTruth(Stamp recorded, Stamp stamp, const Pose& T_wb) {
  geometry_msgs::PoseStamped message;
  message.pose = toMessage(T_wb);
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

}  // namespace vins
