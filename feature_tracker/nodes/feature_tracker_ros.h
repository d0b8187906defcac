#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>

#include "camera_model/rig.h"
#include "feature_tracker/feature_tracker.h"
#include "input_queue.h"
#include "vins_msgs/image_converter.h"

namespace vins::feature_tracker {

/// The feature tracker's ROS face, of node and nodelet alike.
///
/// Private parameters: `config_file`, path of the rig's YAML file (needed; see readRig() and
/// FeatureTrackerOptions for its keys); `image_transport`, "raw" (default), "compressed" (JPEG or
/// PNG by <image_topic>/compressed, decoded here), or another transport that is installed.
///
/// Subscribes the file's image_topic, image1_topic, imu_topic and camera_info_topic. Publishes, in
/// the node's own namespace: `feature` (vins_msgs/FeatureFrame), `feature_img` (sensor_msgs/Image,
/// drawn only where somebody subscribes), `restart` (std_msgs/Bool, true when time jumped); and
/// /diagnostics.
class FeatureTrackerRos {
 public:
  /// Throws InputError for parameters and files that are missing or bad.
  FeatureTrackerRos(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);
  ~FeatureTrackerRos();

  FeatureTrackerRos(const FeatureTrackerRos&) = delete;
  FeatureTrackerRos& operator=(const FeatureTrackerRos&) = delete;

 private:
  /// What diagnostics tell.
  struct Health {
    int images = 0;
    int refused = 0;
    int observations = 0;
    TrackerStatistics statistics;
    std::string last_problem;
    ros::WallTime last_image;   ///< when it was worked on
    int dropped = 0;            ///< images, as told the last time
    double milliseconds = 0.0;  ///< mean of track(), smoothed
  };

  void readConfiguration();
  void makeTracker();
  void advertise();
  void subscribe();
  /// Warns once where camera_info_topic says something else than the file.
  void compareWithCameraInfo();
  void subscribeCamera(int camera, const std::string& topic);
  void work();
  void process(const TrackerInput& input);
  cv::Mat greyOf(const QueuedImage& image, vins_msgs::ImageConverter* converter) const;
  void publish(const FeatureTrackerResult& result, const std::vector<cv::Mat>& images,
               const std::string& frame_id);
  void publishPicture(const FeatureFrame& frame, const std::vector<cv::Mat>& images,
                      const std_msgs::Header& header);
  void hear(const Event& event);
  void refuse(const std::string& why);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void summarize(const Health& health, int newly_dropped,
                 diagnostic_updater::DiagnosticStatusWrapper* status) const;

  ros::NodeHandle handle_, private_handle_;
  camera_model::Rig rig_;
  std::vector<std::shared_ptr<const camera_model::Camera>> cameras_;  // that are followed: 1 or 2
  bool uses_imu_ = false;
  FeatureTrackerOptions options_;
  std::unique_ptr<FeatureTracker> tracker_;
  vins_msgs::ImageConverter converters_[2];  // of the first and of the second camera
  std::unique_ptr<InputQueue> queue_;

  image_transport::ImageTransport transport_, private_transport_;
  ros::Publisher feature_publisher_, restart_publisher_;
  image_transport::Publisher picture_publisher_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber camera_info_;
  std::vector<image_transport::Subscriber> image_subscribers_;
  diagnostic_updater::Updater updater_;
  ros::Timer diagnostic_timer_;

  std::mutex health_mutex_;
  Health health_;
  std::thread worker_;
};

}  // namespace vins::feature_tracker
