#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vins_pipeline/recording.h"

namespace vins::pipeline {

/// A ROS bag, or the bags of a recording that was split (`rosbag record --split`), in any order.
/// Images: sensor_msgs/Image (encodings of vins_msgs::ImageConverter) or CompressedImage;
/// `topic`/compressed is read where `topic` itself is not in the bag. Bags that were not closed
/// (FILE.bag.active, without an index) are read up to their end and damaged ones up to the damage,
/// which the summary tells; files are never changed. IMU: sensor_msgs/Imu. Ground truth, if there:
/// PoseStamped, TransformStamped or PointStamped on /ground_truth/pose,
/// /vicon/firefly_sbx/firefly_sbx or /leica/position, the first that is there. Throws InputError
/// naming the bag: where it cannot be read, where a topic is missing or of a wrong type (naming the
/// topics that it has), for a span that holds nothing, and for a file that is given twice.
std::unique_ptr<Recording> openBagRecording(const std::vector<std::string>& paths,
                                            const RecordingSelection& selection);

/// Bags of one recording, or one folder in the ASL layout. Throws InputError for other paths.
std::unique_ptr<Recording> openRecording(const std::vector<std::string>& paths,
                                         const RecordingSelection& selection);

}  // namespace vins::pipeline
