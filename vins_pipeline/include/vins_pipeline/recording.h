#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "vins_core/imu.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins::pipeline {

/// An image of a recording, decoded when asked for.
struct RecordedImage {
  int camera = 0;   ///< index of its topic in the selection
  Stamp stamp = 0;  ///< [ns]
  /// The image in grey values, CV_8UC1. Throws InputError naming file, topic and stamp where it
  /// cannot be decoded. May be called as long as the recording is there.
  std::function<cv::Mat()> load;
};

/// The body's true pose; without a rotation where a laser tracker has measured.
struct RecordedTruth {
  Stamp stamp = 0;  ///< [ns]
  Pose T_wb;
  bool has_rotation = true;
};

/// A reading of an accelerometer with a topic of its own.
struct RecordedAcceleration {
  Stamp stamp = 0;                                         ///< [ns]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< specific force [m/s^2]
};

/// One message of a recording.
struct Record {
  Stamp arrival = 0;  ///< when it was recorded [ns]
  /// An ImuSample is the gyroscope's alone where accelerations are recorded apart.
  std::variant<ImuSample, RecordedImage, RecordedTruth, RecordedAcceleration> data;
};

/// What to take of a recording.
struct RecordingSelection {
  std::string imu_topic = "/imu0";
  std::string accel_topic;  ///< of an accelerometer with a topic of its own; "" for none
  std::vector<std::string> image_topics = {"/cam0/image_raw"};  ///< one per camera
  double start = 0.0;              ///< after the rig's first selected message [s]
  std::optional<double> duration;  ///< [s]; nothing: to the end

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// What a recording has, in the selected span.
struct RecordingSummary {
  std::string name;  ///< the path it was opened by
  Stamp begin = 0;   ///< of the span, by arrival [ns]
  Stamp end = 0;     ///< of the span, by arrival [ns]
  std::size_t images = 0;
  std::size_t imu_samples = 0;
  std::size_t truth_poses = 0;
  /// Up to where the file could be read and why no further; empty where it is whole.
  std::string damage;
  /// Up to where a recording goes that was ended by force; empty where it was closed.
  std::string interruption;
  std::string truth_source;  ///< topic or folder of the ground truth; empty where there is none

  double duration() const { return toSeconds(end - begin); }
};

/// A recorded flight: a stream of its messages in the order of their headers' stamps, or of their
/// arrival where stamps cannot order (StampOrder).
class Recording {
 public:
  virtual ~Recording() = default;

  const RecordingSummary& summary() const { return summary_; }

  /// The next message; nothing at the end. Throws InputError where the file is broken.
  virtual std::optional<Record> next() = 0;

 protected:
  RecordingSummary summary_;
};

/// A folder in the ASL layout (EuRoC's): topics are /camN/image_raw, at N the topic's own number or
/// else its place in the selection; the IMU's topics are of no meaning, and its samples are
/// whole. Images that are listed but not there are left out. Throws InputError naming what is
/// missing, or a span that holds nothing.
std::unique_ptr<Recording> openAslRecording(const std::string& folder,
                                            const RecordingSelection& selection);

}  // namespace vins::pipeline
