#include <exception>

#include <ros/ros.h>

#include "estimator_ros.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "vins_estimator");
  try {
    vins::EstimatorRos estimator(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
