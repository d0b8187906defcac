// The feature tracker as a node of its own: see FeatureTrackerRos for topics and parameters.

#include <iostream>

#include <ros/ros.h>

#include "feature_tracker_ros.h"
#include "vins_core/input_error.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "feature_tracker");
  try {
    const vins::FeatureTrackerRos tracker(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const vins::InputError& error) {
    std::cerr << "feature_tracker: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
