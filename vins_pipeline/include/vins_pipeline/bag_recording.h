#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "vins_pipeline/recording.h"

namespace vins::pipeline {

/// A ROS bag, or the bags of a recording that was split (`rosbag record --split`), in any order.
/// Images: sensor_msgs/Image (encodings of vins_msgs::ImageConverter) or CompressedImage;
/// `topic`/compressed is read where `topic` itself is not in the bag. Bags that were not closed
/// (FILE.bag.active, without an index) are read up to their end and damaged ones up to the damage,
/// which the summary tells; files are never changed. IMU: sensor_msgs/Imu, where the
/// accelerometer has a topic of its own on both. Ground truth, if there: PoseStamped,
/// TransformStamped or PointStamped on /ground_truth/pose, /vicon/firefly_sbx/firefly_sbx or
/// /leica/position, the first that is there. Throws InputError naming the bag: where it cannot be
/// read, where a topic is missing or of a wrong type (naming the topics that it has), for a span
/// that holds nothing, and for a file that is given twice.
std::unique_ptr<Recording> openBagRecording(const std::vector<std::string>& paths,
                                            const RecordingSelection& selection);

/// The camera that the first message of a topic of sensor_msgs/CameraInfo in the bags describes.
/// Throws InputError naming bag and topic: where a path is no bag, where the topic is missing or of
/// another type, and for a message that describes no camera. Names in a bag are absolute: a '/' at
/// the start of `topic` may be left out.
std::unique_ptr<camera_model::Camera> readCameraInfo(const std::vector<std::string>& paths,
                                                     const std::string& topic);

/// Bags of one recording, or one folder in the ASL layout. Throws InputError for other paths.
std::unique_ptr<Recording> openRecording(const std::vector<std::string>& paths,
                                         const RecordingSelection& selection);

}  // namespace vins::pipeline
