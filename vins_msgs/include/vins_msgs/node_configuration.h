#pragma once

#include <string>

#include <ros/ros.h>

#include "vins_core/input_error.h"
#include "vins_core/parameters.h"
#include "vins_core/rig_keys.h"

namespace vins_msgs {

/// The rig's configuration file of a node: the one that the private parameter `config_file` names.
/// Keys that no stage knows are told by ROS's log, as run_bag tells them. Throws InputError where
/// the parameter is not set, or as Parameters::load() does.
inline vins::Parameters loadConfiguration(const ros::NodeHandle& private_node) {
  std::string path;
  if (!private_node.getParam("config_file", path) || path.empty()) {
    throw vins::InputError("parameter '" + private_node.resolveName("config_file") +
                           "' is not set; allowed: the path of the rig's YAML file");
  }
  vins::Parameters parameters = vins::Parameters::load(path);
  parameters.know(vins::rigKeys());
  for (const std::string& warning : parameters.warnings()) ROS_WARN_STREAM(warning);
  return parameters;
}

}  // namespace vins_msgs
