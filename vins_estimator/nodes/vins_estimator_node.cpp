// A node of its own: see EstimatorRos for topics and parameters.

#include "estimator_ros.h"
#include "vins_msgs/node_main.h"

int main(int argc, char** argv) {
  return vins_msgs::runNode<vins::estimator::EstimatorRos>(argc, argv, "vins_estimator");
}
