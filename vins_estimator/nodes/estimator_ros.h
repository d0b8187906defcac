#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>

#include "estimator_publisher.h"
#include "feature_numbering.h"
#include "vins_core/imu_joiner.h"
#include "vins_estimator/estimator.h"
#include "vins_estimator/inertial/propagator.h"
#include "vins_msgs/FeatureFrame.h"
#include "vins_msgs/LoopMatch.h"
#include "vins_msgs/node_configuration.h"

namespace vins::estimator {

/// The estimator's ROS face, shared by node and nodelet. Callbacks only queue; one worker solves.
/// An IMU sample goes through the propagator in its own callback, so that odometry at the IMU's
/// rate never waits for the solver.
///
/// Private parameters: `config_file` (the rig's YAML; needed), those of EstimatorPublisher. Topics
/// of other stages are looked for in the node's namespace. Service: `~reset`.
class EstimatorRos {
 public:
  /// Throws InputError for a configuration that is missing or malformed.
  EstimatorRos(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  EstimatorRos(const EstimatorRos&) = delete;
  EstimatorRos& operator=(const EstimatorRos&) = delete;
  ~EstimatorRos();

 private:
  /// What callbacks hand to the worker, in the order of arrival.
  struct Input {
    std::optional<ImuSample> imu;
    std::optional<FeatureFrame> frame;
    std::optional<LoopMatch> match;
    bool restart = false;
    std::vector<Event> events;  ///< findings about the inputs
  };

  /// What diagnostics show of a result.
  struct Figures {
    EstimatorStatus status = EstimatorStatus::kInitializing;
    EstimatorStatistics statistics;
    double td = 0.0;                    ///< [s]
    double td_variance = 0.0;           ///< zero where it is not estimated [s^2]
    std::optional<double> scale_sigma;  ///< relative, while the scale converges
  };

  EstimatorRos(ros::NodeHandle node, ros::NodeHandle private_node,
               const vins_msgs::NodeConfiguration& configuration);
  void onImu(const sensor_msgs::Imu::ConstPtr& message);
  void onAcceleration(const sensor_msgs::Imu::ConstPtr& message);
  void onFeatures(const vins_msgs::FeatureFrame::ConstPtr& message);
  void onLoopMatch(const vins_msgs::LoopMatch::ConstPtr& message);
  void onRestart(const std_msgs::Bool::ConstPtr& message);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  void takeSample(const ImuSample& sample);
  void takeJoinedSamples();
  void push(Input input);
  void work();
  void handle(Input* input);
  void handleResults();
  void handle(const std::vector<Event>& events);
  void handle(const EstimatorResult& result);
  void restart();
  void keepFinding(const Event& event);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper* status);
  std::string missingInput() const;
  std::string waitingReason() const;
  /// What is wrong with the inputs, where that was found lately; empty otherwise.
  std::string inputFinding() const;

  EstimatorOptions options_;
  Estimator estimator_;  // the worker's alone
  EstimatorPublisher publisher_;
  FeatureNumbering numbering_;  // of the features' callback

  std::mutex joiner_mutex_;
  std::optional<ImuJoiner> joiner_;  // where the accelerometer has a topic of its own

  std::mutex propagator_mutex_;
  Propagator propagator_;

  std::mutex mutex_;  // of the queue and the latest figures
  std::condition_variable arrived_;
  std::deque<Input> queue_;
  std::size_t frames_waiting_ = 0;
  std::size_t frames_dropped_ = 0;
  std::size_t frames_dropped_told_ = 0;                      // in the last diagnostics
  ros::WallTime last_imu_, last_acceleration_, last_frame_;  // of arrival; zero: none yet
  bool stopping_ = false;
  Figures latest_;
  std::deque<Event> recent_;
  std::string finding_;  // about the inputs, the latest
  ros::WallTime finding_time_;
  std::string rig_finding_;  // what is wrong of the rig, as far as is known

  diagnostic_updater::Updater diagnostics_;
  ros::Subscriber imu_, acceleration_, features_, matches_, restarts_;
  ros::ServiceServer reset_;
  ros::Timer timer_;
  std::thread worker_;
};

}  // namespace vins::estimator
