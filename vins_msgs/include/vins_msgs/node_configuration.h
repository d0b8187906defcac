#pragma once

#include <string>

#include <ros/ros.h>

#include "camera_model/rig.h"
#include "vins_core/input_error.h"
#include "vins_core/parameters.h"

namespace vins_msgs {

/// What a node is configured by: the rig, and the file with the keys of its stage.
struct NodeConfiguration {
  vins::Parameters parameters;
  vins::camera_model::Rig rig;
};

/// Reads the rig's configuration file of a node: the one that the private parameter `config_file`
/// names. Throws InputError where the parameter is not set, or as Parameters::load() and readRig()
/// do.
inline NodeConfiguration loadConfiguration(const ros::NodeHandle& private_node) {
  std::string path;
  if (!private_node.getParam("config_file", path) || path.empty()) {
    throw vins::InputError("parameter '" + private_node.resolveName("config_file") +
                           "' is not set; allowed: the path of the rig's YAML file");
  }
  const vins::Parameters parameters = vins::Parameters::load(path);
  return {parameters, vins::camera_model::readRig(parameters)};
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
