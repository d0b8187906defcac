#include "bag_topics.h"

#include <algorithm>

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "vins_core/input_error.h"

namespace vins::pipeline {
namespace {

std::string listOf(const TopicTypes& types) {
  std::string text;
  for (const auto& [topic, type] : types) {
    text += (text.empty() ? "" : ", ") + topic + " (" + type + ")";
  }
  return text.empty() ? "no topics" : text;
}

}  // namespace

void requireTopic(const std::string& path, const TopicTypes& types, const std::string& topic,
                  const std::vector<std::string>& allowed) {
  const auto found = types.find(topic);
  if (found == types.end()) {
    throw InputError(path + ": has no topic '" + topic + "'; it has " + listOf(types));
  }
  if (std::find(allowed.begin(), allowed.end(), found->second) != allowed.end()) return;
  std::string choices;
  for (const std::string& type : allowed) choices += (choices.empty() ? "" : " or ") + type;
  throw InputError(path + ": topic '" + topic + "' is of type " + found->second +
                   "; allowed: " + choices);
}

std::string definitionOf(const std::string& type) {
  using ros::message_traits::md5sum;
  if (type == kImage) return md5sum<sensor_msgs::Image>();
  if (type == kCompressed) return md5sum<sensor_msgs::CompressedImage>();
  if (type == kCameraInfo) return md5sum<sensor_msgs::CameraInfo>();
  if (type == kImu) return md5sum<sensor_msgs::Imu>();
  if (type == kPose) return md5sum<geometry_msgs::PoseStamped>();
  if (type == kTransform) return md5sum<geometry_msgs::TransformStamped>();
  return md5sum<geometry_msgs::PointStamped>();
}

std::string truthTopicOf(const TopicTypes& types) {
  for (const std::string topic :
       {"/ground_truth/pose", "/vicon/firefly_sbx/firefly_sbx", "/leica/position"}) {
    const auto found = types.find(topic);
    if (found == types.end()) continue;
    const std::string& type = found->second;
    if (type == kPose || type == kTransform || type == kPoint) return topic;
  }
  return "";
}

}  // namespace vins::pipeline
