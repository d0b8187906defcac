#pragma once

#include <memory>
#include <string>

#include "camera_model/camera.h"
#include "vins_pipeline/recording.h"

namespace vins::pipeline {

/// A ROS bag. Images: sensor_msgs/Image (encodings of vins_msgs::ImageConverter) or
/// CompressedImage; `topic`/compressed is read where `topic` itself is not in the bag. A damaged
/// bag is read up to the damage, which the summary tells. IMU: sensor_msgs/Imu, where
/// the accelerometer has a topic of its own on both. Ground truth, if
/// there: PoseStamped, TransformStamped or PointStamped on /ground_truth/pose,
/// /vicon/firefly_sbx/firefly_sbx or /leica/position, the first that is there. Throws InputError
/// naming the bag: where it cannot be read, where a topic is missing or of a wrong type (naming the
/// topics that it has), and for a span that holds nothing.
std::unique_ptr<Recording> openBagRecording(const std::string& path,
                                            const RecordingSelection& selection);

/// The camera that the first message of a topic of sensor_msgs/CameraInfo in a bag describes.
/// Throws InputError naming bag and topic: where `path` is no bag, where the topic is missing or of
/// another type, and for a message that describes no camera. Names in a bag are absolute: a '/' at
/// the start of `topic` may be left out.
std::unique_ptr<camera_model::Camera> readCameraInfo(const std::string& path,
                                                     const std::string& topic);

/// A bag, or a folder in the ASL layout. Throws InputError where `path` is neither.
std::unique_ptr<Recording> openRecording(const std::string& path,
                                         const RecordingSelection& selection);

}  // namespace vins::pipeline
