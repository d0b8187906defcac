#include <exception>

#include <ros/ros.h>

#include "pose_graph_ros.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "pose_graph");
  try {
    vins::PoseGraphRos graph(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
    graph.finish();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
