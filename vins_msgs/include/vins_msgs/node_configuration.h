#pragma once

#include <memory>
#include <string>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "camera_model/rig.h"
#include "vins_core/input_error.h"
#include "vins_core/parameters.h"
#include "vins_msgs/camera_info.h"

namespace vins_msgs {

/// What a node is configured by: the rig, and the file with the keys of its stage.
struct NodeConfiguration {
  vins::Parameters parameters;
  vins::camera_model::Rig rig;
};

/// Waits for the first message of a topic of sensor_msgs/CameraInfo, and says every five seconds
/// what it waits for. Spins a queue of its own, so that it may be called before the node spins.
/// Throws InputError where the message describes no camera, or where ROS ends.
inline std::shared_ptr<const vins::camera_model::Camera> waitForCamera(ros::NodeHandle node,
                                                                       const std::string& topic) {
  ros::CallbackQueue queue;
  node.setCallbackQueue(&queue);
  sensor_msgs::CameraInfo::ConstPtr info;
  const boost::function<void(const sensor_msgs::CameraInfo::ConstPtr&)> take =
      [&info](const sensor_msgs::CameraInfo::ConstPtr& message) { info = message; };
  const ros::Subscriber subscriber = node.subscribe<sensor_msgs::CameraInfo>(topic, 1, take);
  ros::WallTime told = ros::WallTime::now();
  while (ros::ok() && !info) {
    queue.callAvailable(ros::WallDuration(0.1));
    if (info || (ros::WallTime::now() - told).toSec() < 5.0) continue;
    told = ros::WallTime::now();
    ROS_WARN_STREAM("waiting for the camera's intrinsics on "
                    << subscriber.getTopic()
                    << ": does the camera or the bag run, is camera_info_topic right?");
  }
  if (!info) throw vins::InputError("ended while waiting for " + subscriber.getTopic());
  return cameraOf(*info, subscriber.getTopic());
}

/// Reads the rig's configuration file of a node: the one that the private parameter `config_file`
/// names. Where it leaves the intrinsics to camera_info_topic, waits for them. Throws InputError
/// where the parameter is not set, or as Parameters::load(), readRig() and waitForCamera() do.
inline NodeConfiguration loadConfiguration(const ros::NodeHandle& node,
                                           const ros::NodeHandle& private_node) {
  std::string path;
  if (!private_node.getParam("config_file", path) || path.empty()) {
    throw vins::InputError("parameter '" + private_node.resolveName("config_file") +
                           "' is not set; allowed: the path of the rig's YAML file");
  }
  const vins::Parameters parameters = vins::Parameters::load(path);
  const auto wait = [&](const std::string& topic) { return waitForCamera(node, topic); };
  return {parameters, vins::camera_model::readRig(parameters, wait)};
}

/// Logs what a user should hear of the file: what was mended or has no effect, keys that no stage
/// knows. The feature tracker does, for all nodes of the rig.
inline void logWarnings(const NodeConfiguration& configuration) {
  for (const std::string& warning :
       vins::camera_model::configurationWarnings(configuration.parameters, configuration.rig)) {
    ROS_WARN_STREAM(warning);
  }
}

}  // namespace vins_msgs
