#include "feature_tracker_ros.h"

#include <chrono>
#include <sstream>

#include <boost/make_shared.hpp>
#include <cv_bridge/cv_bridge.h>
#include <opencv2/imgproc.hpp>
#include <std_msgs/Bool.h>

#include "feature_tracker/mask_file.h"
#include "feature_tracker/track_drawing.h"
#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"
#include "vins_msgs/node_configuration.h"

namespace vins::feature_tracker {
namespace {

constexpr int kImageQueue = 10;
constexpr int kImuQueue = 2000;
constexpr double kSmoothing = 0.05;  // weight of the latest image in the mean time
constexpr double kSilence = 2.0;     // without images, before somebody is told [s]

}  // namespace

FeatureTrackerRos::FeatureTrackerRos(const ros::NodeHandle& handle,
                                     const ros::NodeHandle& private_handle)
    : handle_(handle),
      private_handle_(private_handle),
      transport_(handle),
      private_transport_(private_handle),
      updater_(handle, private_handle) {
  // The tracker is fast enough alone, and the estimator needs the other cores.
  cv::setNumThreads(1);
  readConfiguration();
  advertise();
  subscribe();
  // Last: what has thrown must not leave a thread behind.
  worker_ = std::thread([this] { work(); });
}

FeatureTrackerRos::~FeatureTrackerRos() {
  queue_->close();
  worker_.join();
}

void FeatureTrackerRos::readConfiguration() {
  const vins_msgs::NodeConfiguration configuration =
      vins_msgs::loadConfiguration(handle_, private_handle_);
  vins_msgs::logWarnings(configuration);
  rig_ = configuration.rig;
  camera_model::requireImageTopic(configuration.parameters, rig_);
  options_ = readFeatureTrackerOptions(configuration.parameters, rig_);
  makeTracker();
  uses_imu_ = options_.uses_gyroscope && !rig_.imu.topic.empty();
  queue_ = std::make_unique<InputQueue>(cameras_.size() == 2, uses_imu_, rig_.cameras.front().td);
  std::ostringstream text;
  text << options_;
  ROS_INFO_STREAM("feature tracker, from " << rig_.file << ":\n" << text.str());
  if (!uses_imu_)
    ROS_WARN("no imu_topic or no extrinsic rotation: tracks are predicted without it");
}

void FeatureTrackerRos::makeTracker() {
  std::vector<Pose> T_bc;
  for (const camera_model::RigCamera& camera : rig_.cameras) {
    // Not more than the tracker takes, and none that no topic feeds.
    if (cameras_.size() == 2 || camera.image_topic.empty()) break;
    cameras_.push_back(camera.camera);
    T_bc.push_back(camera.T_bc);
  }
  const cv::Mat mask = readMaskFile(options_.mask_file, cameras_.front()->imageSize());
  tracker_ = std::make_unique<FeatureTracker>(cameras_, T_bc, options_, mask);
}

void FeatureTrackerRos::advertise() {
  feature_publisher_ = private_handle_.advertise<vins_msgs::FeatureFrame>("feature", 100);
  restart_publisher_ = private_handle_.advertise<std_msgs::Bool>("restart", 100);
  picture_publisher_ = private_transport_.advertise("feature_img", 2);
  updater_.setHardwareID("none");
  updater_.add("feature tracker", this, &FeatureTrackerRos::diagnose);
  diagnostic_timer_ = handle_.createTimer(ros::Duration(0.5),
                                          [this](const ros::TimerEvent&) { updater_.update(); });
}

void FeatureTrackerRos::subscribe() {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    subscribeCamera(static_cast<int>(i), rig_.cameras[i].image_topic);
  }
  const camera_model::RigCamera& camera = rig_.cameras.front();
  if (!camera.camera_info_topic.empty() && !camera.is_from_topic) compareWithCameraInfo();
  if (!uses_imu_) return;
  const boost::function<void(const sensor_msgs::ImuConstPtr&)> take =
      [this](const sensor_msgs::ImuConstPtr& message) {
        queue_->addImu(vins_msgs::fromMsg(*message));
      };
  subscribers_.push_back(handle_.subscribe<sensor_msgs::Imu>(
      rig_.imu.topic, kImuQueue, take, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void FeatureTrackerRos::compareWithCameraInfo() {
  const boost::function<void(const sensor_msgs::CameraInfoConstPtr&)> compare =
      [this](const sensor_msgs::CameraInfoConstPtr& message) {
        const std::string topic = camera_info_.getTopic();
        camera_info_.shutdown();  // the first message is enough
        try {
          const auto difference = camera_model::describeDifference(
              *cameras_.front(), *vins_msgs::cameraOf(*message, topic), topic);
          if (difference) ROS_WARN_STREAM(*difference);
        } catch (const InputError& error) {
          ROS_WARN_STREAM(error.what());
        }
      };
  camera_info_ = handle_.subscribe<sensor_msgs::CameraInfo>(rig_.cameras.front().camera_info_topic,
                                                            1, compare);
}

void FeatureTrackerRos::subscribeCamera(int camera, const std::string& topic) {
  const std::string transport = private_handle_.param("image_transport", std::string("raw"));
  if (transport == "compressed") {
    // Decoded here: the transport's plugin is not to be had on every system.
    const boost::function<void(const sensor_msgs::CompressedImageConstPtr&)> take =
        [this, camera](const sensor_msgs::CompressedImageConstPtr& message) {
          QueuedImage image;
          image.stamp = vins_msgs::toStamp(message->header.stamp);
          image.compressed = message;
          queue_->addImage(camera, std::move(image));
        };
    subscribers_.push_back(
        handle_.subscribe<sensor_msgs::CompressedImage>(topic + "/compressed", kImageQueue, take));
    return;
  }
  const auto take = [this, camera](const sensor_msgs::ImageConstPtr& message) {
    QueuedImage image;
    image.stamp = vins_msgs::toStamp(message->header.stamp);
    image.raw = message;
    queue_->addImage(camera, std::move(image));
  };
  try {
    image_subscribers_.push_back(transport_.subscribe(topic, kImageQueue, take, ros::VoidPtr(),
                                                      image_transport::TransportHints(transport)));
  } catch (const image_transport::TransportLoadException& error) {
    throw InputError("parameter image_transport is '" + transport + "': " + error.what());
  }
}

void FeatureTrackerRos::work() {
  while (const auto input = queue_->take()) process(*input);
}

cv::Mat FeatureTrackerRos::greyOf(const QueuedImage& image,
                                  vins_msgs::ImageConverter* converter) const {
  return image.raw ? converter->toGrey(*image.raw) : converter->toGrey(*image.compressed);
}

void FeatureTrackerRos::process(const TrackerInput& input) {
  std::vector<cv::Mat> images;
  try {
    images.push_back(greyOf(input.first, &converters_[0]));
    if (input.second) images.push_back(greyOf(*input.second, &converters_[1]));
  } catch (const InputError& error) {
    refuse(error.what());
    if (images.empty()) return;
  }
  const auto start = std::chrono::steady_clock::now();
  const FeatureTrackerResult result = tracker_->track(images, input.first.stamp, input.imu);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  for (const Event& event : result.events) hear(event);
  const auto& first = input.first;
  publish(result, images,
          first.raw ? first.raw->header.frame_id : first.compressed->header.frame_id);
  const std::lock_guard<std::mutex> lock(health_mutex_);
  ++health_.images;
  health_.last_image = ros::WallTime::now();
  health_.statistics = result.statistics;
  if (result.frame) health_.observations = static_cast<int>(result.frame->observations.size());
  health_.milliseconds =
      health_.images == 1 ? took.count()
                          : (1.0 - kSmoothing) * health_.milliseconds + kSmoothing * took.count();
}

void FeatureTrackerRos::publish(const FeatureTrackerResult& result,
                                const std::vector<cv::Mat>& images, const std::string& frame_id) {
  if (result.restarted) {
    std_msgs::Bool restart;
    restart.data = true;
    restart_publisher_.publish(restart);
  }
  if (!result.frame) return;
  // Shared, so that nodelets of one manager get it without a copy.
  const auto message = boost::make_shared<vins_msgs::FeatureFrame>(vins_msgs::toMsg(*result.frame));
  message->header.frame_id = frame_id;
  feature_publisher_.publish(message);
  publishPicture(*result.frame, images, message->header);
}

void FeatureTrackerRos::publishPicture(const FeatureFrame& frame,
                                       const std::vector<cv::Mat>& images,
                                       const std_msgs::Header& header) {
  if (!options_.draw_tracks || picture_publisher_.getNumSubscribers() == 0) return;
  cv::Mat picture = drawTracks(images[0], frame, *cameras_[0]);
  if (images.size() == 2 && cameras_.size() == 2 && images[1].rows == picture.rows) {
    cv::hconcat(picture, drawTracks(images[1], frame, *cameras_[1], 1), picture);
  }
  picture_publisher_.publish(cv_bridge::CvImage(header, "bgr8", picture).toImageMsg());
}

void FeatureTrackerRos::hear(const Event& event) {
  if (event.code == "image_refused") return refuse(event.text);
  std::ostringstream text;
  text << event;
  if (event.severity == Severity::kInfo) {
    ROS_INFO_STREAM(text.str());
  } else {
    ROS_WARN_STREAM(text.str());
  }
}

void FeatureTrackerRos::refuse(const std::string& why) {
  ROS_ERROR_STREAM_THROTTLE(1.0, why);
  const std::lock_guard<std::mutex> lock(health_mutex_);
  ++health_.refused;
  health_.last_problem = why;
}

void FeatureTrackerRos::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const int dropped = queue_->dropped();
  Health health;
  {
    const std::lock_guard<std::mutex> lock(health_mutex_);
    health = health_;
    health_.last_problem.clear();
    health_.dropped = dropped;
  }
  summarize(health, dropped - health.dropped, &status);
  status.add("image topic", rig_.cameras[0].image_topic);
  status.add("IMU topic", rig_.imu.topic);
  status.add("images", health.images);
  status.add("images refused", health.refused);
  status.add("images dropped", dropped);
  status.add("observations", health.observations);
  status.add("inlier ratio", health.statistics.inlier_ratio);
  status.add("mean track length [images]", health.statistics.mean_track_length);
  status.add("gyroscope used", health.statistics.turn_measured);
  status.add("time per image [ms]", health.milliseconds);
}

void FeatureTrackerRos::summarize(const Health& health, int newly_dropped,
                                  diagnostic_updater::DiagnosticStatusWrapper* status) const {
  using Level = diagnostic_msgs::DiagnosticStatus;
  const std::string of_topic = " on " + rig_.cameras[0].image_topic;
  if (!health.last_problem.empty()) return status->summary(Level::ERROR, health.last_problem);
  if (health.images == 0) {
    return status->summary(Level::WARN, "no image yet" + of_topic +
                                            ": does the camera or the bag run, is image_topic "
                                            "right? (rostopic hz)");
  }
  status->summary(Level::OK, "tracking");
  if ((ros::WallTime::now() - health.last_image).toSec() > kSilence) {
    status->summary(Level::WARN, "images have stopped" + of_topic +
                                     ": has the bag ended, has the camera stopped?");
  } else if (health.statistics.inliers < options_.min_tracks) {
    status->summary(Level::WARN, "only " + std::to_string(health.statistics.inliers) +
                                     " tracks: is the lens free, is there light and texture?");
  } else if (uses_imu_ && health.images > 1 && !health.statistics.turn_measured) {
    status->mergeSummary(Level::WARN, "no IMU samples for the images on " + rig_.imu.topic +
                                          ": is imu_topic right, do both stamps come from one "
                                          "clock?");
  }
  if (newly_dropped > 0) {
    status->mergeSummary(Level::WARN, std::to_string(newly_dropped) +
                                          " images dropped: the processor is too slow; lower "
                                          "max_cnt, or set freq to 10");
  }
}

}  // namespace vins::feature_tracker
