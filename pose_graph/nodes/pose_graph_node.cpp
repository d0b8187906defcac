// A node of its own: see PoseGraphRos for topics and parameters.

#include "pose_graph_ros.h"
#include "vins_msgs/node_main.h"

int main(int argc, char** argv) {
  return vins_msgs::runNode<vins::pose_graph::PoseGraphRos>(
      argc, argv, "pose_graph", [](vins::pose_graph::PoseGraphRos& graph) { graph.finish(); });
}
