#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "picture_store.h"
#include "pose_graph/place/recent_images.h"
#include "pose_graph/pose_graph.h"
#include "pose_graph_publisher.h"
#include "vins_msgs/Keyframe.h"
#include "vins_msgs/KeyframePoseUpdate.h"
#include "vins_msgs/LoopEdge.h"

namespace vins {

/// The pose graph's ROS face, shared by node and nodelet. Callbacks only queue; one worker
/// describes and compares, and the optimization has a thread of its own.
///
/// Private parameters: `config_file` (the rig's YAML; needed), `map_frame`, `odom_frame`,
/// `image_transport` is raw. Subscribes the file's image_topic and the estimator's `keyframe`,
/// `keyframe_pose_update`, `loop_edge` and `odometry`.
class PoseGraphRos {
 public:
  /// Throws InputError for a configuration that is missing or malformed.
  PoseGraphRos(ros::NodeHandle node, ros::NodeHandle private_node);
  PoseGraphRos(const PoseGraphRos&) = delete;
  PoseGraphRos& operator=(const PoseGraphRos&) = delete;
  ~PoseGraphRos();

 private:
  /// What callbacks hand to the worker, in the order of arrival.
  using Input = std::variant<Keyframe, KeyframePoseUpdate, LoopEdge, nav_msgs::Odometry>;

  void subscribe(ros::NodeHandle node);
  void onImage(const sensor_msgs::Image::ConstPtr& message);
  void push(Input input);
  void work();
  void handle(const Keyframe& keyframe);
  void handle(const KeyframePoseUpdate& update) { graph_->update(update); }
  void handle(const LoopEdge& edge);
  void handle(const nav_msgs::Odometry& odometry);
  void showLoop(const Keyframe& keyframe, const cv::Mat& image, const PoseGraphResult& result);
  void hear(const std::vector<Event>& events);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper* status);

  PoseGraphConfiguration configuration_;
  std::string image_topic_;
  std::unique_ptr<PoseGraph> graph_;  // the worker's alone
  PoseGraphPublisher publisher_;
  PictureStore pictures_;
  std::uint32_t sequence_ = 0;  // of the newest keyframe

  std::mutex mutex_;  // of all below
  std::condition_variable arrived_;
  std::deque<Input> queue_;
  RecentImages images_;
  std::size_t dropped_ = 0;
  std::size_t dropped_told_ = 0;  // in the last diagnostics
  std::size_t without_image_ = 0;
  bool stopping_ = false;
  PoseGraphStatistics statistics_;
  std::deque<Event> recent_;

  diagnostic_updater::Updater diagnostics_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Timer timer_;
  std::thread worker_;
};

}  // namespace vins
