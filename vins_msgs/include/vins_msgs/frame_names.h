#pragma once

#include <map>
#include <sstream>
#include <string>

#include <ros/ros.h>

#include "vins_core/input_error.h"

namespace vins_msgs {

/// Names of the frames in all that is published (REP 105), for every node alike.
struct FrameNames {
  std::string map = "map";        ///< corrected by loops
  std::string odom = "odom";      ///< the odometry's world
  std::string body = "body";      ///< the IMU
  std::string camera = "camera";  ///< the first camera; empty: body -> camera is not in tf
  /// The robot's frame, whose pose in `odom` is published in place of the body's; its pose to the
  /// body comes by tf, as from a URDF. Empty: the body itself.
  std::string base;

  /// Whether another frame than the body is published.
  bool hasBase() const { return !base.empty() && base != body; }
  /// The child frame of the odometry.
  const std::string& child() const { return hasBase() ? base : body; }

  /// `node`: its private namespace, for messages. Throws InputError naming the first name that is
  /// empty where it must not be, begins with a slash, which tf2 does not allow, or is another
  /// frame's.
  void validate(const std::string& node) const {
    std::map<std::string, std::string> seen;
    const auto check = [&](const std::string& key, const std::string& name, bool may_be_empty) {
      const std::string found = "parameter " + node + "/" + key + " is '" + name + "'; allowed: ";
      if (name.empty() && may_be_empty) return;
      if (name.empty() || name.front() == '/') {
        throw vins::InputError(found + "a frame's name that does not begin with a slash");
      }
      const auto [other, is_new] = seen.emplace(name, key);
      if (!is_new) throw vins::InputError(found + "another name than that of " + other->second);
    };
    check("map_frame", map, false);
    check("odom_frame", odom, false);
    check("body_frame", body, false);
    check("camera_frame", camera, true);
    check("base_frame", hasBase() ? base : "", true);
  }
};

/// Reads the private parameters `map_frame`, `odom_frame`, `body_frame`, `camera_frame` and
/// `base_frame`; what is not set keeps its default. Throws InputError as FrameNames::validate().
inline FrameNames readFrameNames(const ros::NodeHandle& private_node) {
  FrameNames names;
  private_node.param("map_frame", names.map, names.map);
  private_node.param("odom_frame", names.odom, names.odom);
  private_node.param("body_frame", names.body, names.body);
  private_node.param("camera_frame", names.camera, names.camera);
  private_node.param("base_frame", names.base, names.base);
  names.validate(private_node.getNamespace());
  return names;
}

/// A private parameter that is 0 or 1, or true or false; `otherwise` where it is not set. Throws
/// InputError for other values.
inline bool readSwitch(const ros::NodeHandle& private_node, const std::string& key,
                       bool otherwise) {
  XmlRpc::XmlRpcValue value;
  if (!private_node.getParam(key, value)) return otherwise;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeBoolean) return static_cast<bool>(value);
  const bool is_number = value.getType() == XmlRpc::XmlRpcValue::TypeInt;
  const int number = is_number ? static_cast<int>(value) : -1;
  if (number == 0 || number == 1) return number == 1;
  std::ostringstream found;
  value.write(found);
  throw vins::InputError("parameter " + private_node.resolveName(key) + " is '" + found.str() +
                         "'; allowed: 0 or 1");
}

}  // namespace vins_msgs
