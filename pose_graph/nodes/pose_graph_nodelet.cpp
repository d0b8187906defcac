#include <exception>
#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "pose_graph_ros.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {

/// The pose graph in a nodelet manager.
class PoseGraphNodelet : public nodelet::Nodelet {
 public:
  ~PoseGraphNodelet() override {
    try {
      if (graph_) graph_->finish();
    } catch (const std::exception& error) {
      NODELET_ERROR_STREAM(error.what());
    }
  }

 private:
  void onInit() override {
    try {
      graph_ = std::make_unique<PoseGraphRos>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;
    }
  }

  std::unique_ptr<PoseGraphRos> graph_;
};

}  // namespace vins::pose_graph

PLUGINLIB_EXPORT_CLASS(vins::pose_graph::PoseGraphNodelet, nodelet::Nodelet)
