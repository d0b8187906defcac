// A node of its own: see FeatureTrackerRos for topics and parameters.

#include "feature_tracker_ros.h"
#include "vins_msgs/node_main.h"

int main(int argc, char** argv) {
  return vins_msgs::runNode<vins::feature_tracker::FeatureTrackerRos>(argc, argv,
                                                                      "feature_tracker");
}
