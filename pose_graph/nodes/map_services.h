#pragma once

#include <functional>
#include <future>
#include <memory>
#include <string>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "vins_msgs/MapFile.h"

namespace vins::pose_graph {

/// What a map service was asked for, and where its answer goes: one that is thrown away unanswered
/// is told to the caller as such.
struct MapRequest {
  bool saves = false;  ///< otherwise loads
  std::string file;    ///< "": the configured one
  std::shared_ptr<std::promise<vins_msgs::MapFile::Response>> answer;
};

/// The services `~save_map` and `~load_map`, on a thread of their own: whoever works on the map may
/// take its time, and images and keyframes come in meanwhile.
class MapServices {
 public:
  /// `hand` passes a request on; it is called on the services' thread.
  MapServices(ros::NodeHandle private_node, std::function<void(MapRequest)> hand);

 private:
  bool serve(bool saves, const vins_msgs::MapFile::Request& request,
             vins_msgs::MapFile::Response* response);
  ros::ServiceServer advertise(ros::NodeHandle* node, const std::string& name, bool saves);

  std::function<void(MapRequest)> hand_;
  ros::CallbackQueue queue_;
  ros::ServiceServer save_, load_;
  ros::AsyncSpinner spinner_;  ///< last: it works on the others
};

}  // namespace vins::pose_graph
