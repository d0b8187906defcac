#pragma once

#include <exception>
#include <functional>
#include <iostream>

#include <ros/ros.h>

namespace vins_msgs {

/// Exit codes of a node.
enum NodeExit { kEnded = 0, kBadInput = 1 };

/// The main() of a node: makes its ROS face from the public and the private handle, and serves
/// until Ctrl-C, or until a second node of its name takes its place. What stops it from starting is
/// told in one line. `at_end` is called once it has stopped serving; what it throws is told, too.
template <typename Face>
int runNode(
    int argc, char** argv, const char* name,
    const std::function<void(Face&)>& at_end = [](Face&) {}) {
  try {
    ros::init(argc, argv, name);
    const ros::NodeHandle handle;
    if (!ros::ok()) {
      std::cerr << name << ": ended before a ROS master was there\n";
      return kBadInput;
    }
    Face face(handle, ros::NodeHandle("~"));
    ros::spin();
    at_end(face);
    return kEnded;
  } catch (const std::exception& error) {
    // Not by ROS's log: it falls silent once the last handle is gone.
    std::cerr << name << ": " << error.what() << "\n";
  }
  return kBadInput;
}

}  // namespace vins_msgs
