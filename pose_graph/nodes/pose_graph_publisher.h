#pragma once

#include <map>
#include <string>
#include <vector>

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "pose_graph/graph/map_from_odom.h"
#include "pose_graph/pose_graph.h"
#include "vins_msgs/frame_names.h"

namespace vins::pose_graph {

/// Turns the pose graph's results into messages. Topics live in the node's own namespace, under the
/// names that VINS-Mono's users know:
/// - `pose_graph_path`: all keyframes of the map; `path_1`, `path_2`, ...: those of the first, the
///   second sequence; `base_path`: those of the map that are not of the newest run, loaded
///   maps too (latched);
///   `no_loop_path`: the newest run as the odometry alone has it;
/// - `pose_graph`: steps and loops as markers; `match_image`: a picture of each loop;
/// - `odometry`: corrected; `loop_match`: for the estimator; `event`.
/// Paths and pictures are made only where somebody subscribes.
class PoseGraphPublisher {
 public:
  /// Reads the frames' names (FrameNames) and the switch `publish_tf` (1) from the node's
  /// parameters. Throws InputError for values that are not allowed.
  explicit PoseGraphPublisher(const ros::NodeHandle& node);

  void publish(const std::vector<Event>& events);
  void publish(const LoopMatch& match);

  /// The odometry moved into the map, and map -> odom in tf.
  void publish(const nav_msgs::Odometry& odometry, const MapFromOdom& map_from_odom);

  /// Paths and markers; at most twice a second unless `now`.
  void publishPaths(PoseGraph* graph, bool now);

  bool wantsPictures() const { return picture_.getNumSubscribers() > 0; }
  void publishPicture(Stamp stamp, const cv::Mat& picture);

 private:
  void publishMapPath(const std::vector<SequencePath>& paths, bool now);
  void publishSequences(const std::vector<SequencePath>& paths);

  ros::NodeHandle node_;
  vins_msgs::FrameNames frames_;
  bool publishes_tf_;
  ros::Publisher match_, path_, no_loop_path_, base_path_, markers_, picture_, odometry_, events_;
  std::map<SequenceNumber, ros::Publisher> sequences_;
  ros::WallTime last_paths_;
  tf2_ros::TransformBroadcaster transforms_;
};

}  // namespace vins::pose_graph
