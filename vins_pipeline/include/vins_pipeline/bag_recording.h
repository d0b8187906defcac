#pragma once

#include <memory>
#include <string>

#include "vins_pipeline/recording.h"

namespace vins::pipeline {

/// A ROS bag. Images: sensor_msgs/Image (encodings of vins_msgs::ImageConverter) or
/// CompressedImage; `topic`/compressed is read where `topic` itself is not in the bag. A damaged
/// bag is read up to the damage, which the summary tells. IMU: sensor_msgs/Imu. Ground truth, if
/// there: PoseStamped, TransformStamped or PointStamped on /ground_truth/pose,
/// /vicon/firefly_sbx/firefly_sbx or /leica/position, the first that is there. Throws InputError
/// naming the bag: where it cannot be read, where a topic is missing or of a wrong type (naming the
/// topics that it has), and for a span that holds nothing.
std::unique_ptr<Recording> openBagRecording(const std::string& path,
                                            const RecordingSelection& selection);

/// A bag, or a folder in the ASL layout. Throws InputError where `path` is neither.
std::unique_ptr<Recording> openRecording(const std::string& path,
                                         const RecordingSelection& selection);

}  // namespace vins::pipeline
