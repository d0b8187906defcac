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
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include "keyframe_numbering.h"
#include "map_services.h"
#include "odometry_hold.h"
#include "pose_graph/map/picture_store.h"
#include "pose_graph/place/recent_images.h"
#include "pose_graph/pose_graph.h"
#include "pose_graph_publisher.h"
#include "vins_msgs/Keyframe.h"
#include "vins_msgs/KeyframePoseUpdate.h"
#include "vins_msgs/LoopEdge.h"
#include "vins_msgs/image_converter.h"
#include "vins_msgs/node_configuration.h"

namespace vins::pose_graph {

/// The pose graph's ROS face, shared by node and nodelet. Callbacks only queue; one worker
/// describes and compares, and the optimization has a thread of its own.
///
/// Private parameters: `config_file` (the rig's YAML; needed), those of PoseGraphPublisher;
/// `load_map` (a map file to begin with; otherwise the one of pose_graph_save_path, where the YAML
/// has load_previous_pose_graph) and `save_map` (where finish() writes the map); `image_transport`
/// (raw, or compressed: the images of `image_topic`/compressed). Subscribes the file's image_topic
/// and the estimator's `keyframe`, `keyframe_pose_update`, `loop_edge` and `odometry`. Serves
/// `~save_map` and `~load_map`.
class PoseGraphRos {
 public:
  /// Throws InputError for a configuration or a map that is missing or malformed.
  PoseGraphRos(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  PoseGraphRos(const PoseGraphRos&) = delete;
  PoseGraphRos& operator=(const PoseGraphRos&) = delete;
  ~PoseGraphRos();

  /// The end of all input: saves the map where `save_map` wants it. Nothing is taken any more.
  /// Throws InputError where it cannot be written.
  void finish();

 private:
  /// An image as it came; one of the two is set, or none where there is no image.
  struct ImageMessage {
    sensor_msgs::ImageConstPtr raw;
    sensor_msgs::CompressedImageConstPtr compressed;
  };

  /// What callbacks hand to the worker, in the order of arrival.
  using Input =
      std::variant<Keyframe, KeyframePoseUpdate, LoopEdge, nav_msgs::Odometry, MapRequest>;

  PoseGraphRos(ros::NodeHandle node, ros::NodeHandle private_node,
               const vins_msgs::NodeConfiguration& configuration);
  void subscribe(ros::NodeHandle node);
  void subscribeImages(ros::NodeHandle* node);
  void onImage(const ros::Time& stamp, const ImageMessage& message);
  cv::Mat imageOf(Stamp stamp);
  void push(Input input);
  void work();
  void handle(Keyframe keyframe);
  void handle(KeyframePoseUpdate update);
  void handle(LoopEdge edge);
  void handle(const nav_msgs::Odometry& odometry);
  void handle(const MapRequest& request);
  void correct(const nav_msgs::Odometry& odometry);
  void stop();
  void loadFirstMap(const ros::NodeHandle& private_node);
  std::string saveMap(const std::string& file);
  std::string loadMap(const std::string& file);
  void showLoop(const Keyframe& keyframe, const cv::Mat& image, const PoseGraphResult& result);
  void hear(const std::vector<Event>& events);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper* status);

  PoseGraphConfiguration configuration_;
  std::string image_topic_;
  bool is_compressed_ = false;           // the images of image_topic_
  vins_msgs::ImageConverter converter_;  // the image callback's alone
  std::unique_ptr<PoseGraph> graph_;     // the worker's alone
  PoseGraphPublisher publisher_;
  PictureStore pictures_;
  KeyframeNumbering numbering_;  // the worker's alone
  OdometryHold hold_;            // the worker's alone
  std::uint32_t sequence_ = 0;   // of the newest keyframe
  std::string save_at_end_;

  std::mutex mutex_;  // of all below
  std::condition_variable arrived_;
  std::deque<Input> queue_;
  RecentImages<ImageMessage> images_;
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
  std::unique_ptr<MapServices> services_;
};

}  // namespace vins::pose_graph
