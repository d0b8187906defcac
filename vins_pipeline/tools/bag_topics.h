#pragma once

#include <map>
#include <string>
#include <vector>

namespace vins::pipeline {

/// Types of topics, by their names.
using TopicTypes = std::map<std::string, std::string>;

constexpr char kImage[] = "sensor_msgs/Image";
constexpr char kCompressed[] = "sensor_msgs/CompressedImage";
constexpr char kCameraInfo[] = "sensor_msgs/CameraInfo";
constexpr char kImu[] = "sensor_msgs/Imu";
constexpr char kPose[] = "geometry_msgs/PoseStamped";
constexpr char kTransform[] = "geometry_msgs/TransformStamped";
constexpr char kPoint[] = "geometry_msgs/PointStamped";

/// Throws InputError naming `path` where the topic is not there, or of none of the `allowed` types.
void requireTopic(const std::string& path, const TopicTypes& types, const std::string& topic,
                  const std::vector<std::string>& allowed);

/// The checksum of the definition of one of the types above, as it is known here.
std::string definitionOf(const std::string& type);

/// The topic of ground truth, or "".
std::string truthTopicOf(const TopicTypes& types);

}  // namespace vins::pipeline
