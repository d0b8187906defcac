#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "vins_core/imu.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins::pipeline {

/// The topics of a recording, as EuRoC's bags have them.
namespace topic {
constexpr char kCamera0[] = "/cam0/image_raw";
constexpr char kCamera1[] = "/cam1/image_raw";
constexpr char kImu[] = "/imu0";
constexpr char kGroundTruth[] = "/ground_truth/pose";
}  // namespace topic

/// Writes a recording as a ROS bag. It is written aside (FILE.part) and renamed by finish(), so
/// that no half-written bag is left behind; its folder is made where it is missing. The same calls
/// give the same bytes. Every function throws InputError naming the file where it cannot be
/// written, and for stamps that ROS has no time for (below 1 ns, from 2106 on).
class BagWriter {
 public:
  explicit BagWriter(const std::string& path);
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  /// Removes what was written, unless finished.
  ~BagWriter();

  /// sensor_msgs/Image, mono8, of a CV_8UC1 image. `recorded`: when the message arrives; messages
  /// are written in the order of arrival, so it must not fall.
  void writeImage(const std::string& topic, Stamp recorded, Stamp stamp, const cv::Mat& image);

  /// sensor_msgs/Imu without orientation, stamped by the sample.
  void writeImu(Stamp recorded, const ImuSample& sample);

  /// geometry_msgs/PoseStamped of the body in the world.
  void writeGroundTruth(Stamp recorded, Stamp stamp, const Pose& T_wb);

  /// Closes the bag and gives it its name.
  void finish();

 private:
  class Bag;

  template <typename Message>
  void write(const std::string& topic, Stamp recorded, Message* message, Stamp stamp,
             const std::string& frame);

  std::string path_;
  std::unique_ptr<Bag> bag_;
};

}  // namespace vins::pipeline
