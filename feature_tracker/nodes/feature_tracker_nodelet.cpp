// The feature tracker in a nodelet manager: images of the same process come without a copy.

#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "feature_tracker_ros.h"
#include "vins_core/input_error.h"

namespace vins::feature_tracker {

/// See FeatureTrackerRos for topics and parameters.
class FeatureTrackerNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      tracker_ = std::make_unique<FeatureTrackerRos>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      // The manager catches this, says it, and does not load the nodelet.
      NODELET_FATAL_STREAM(error.what());
      throw;
    }
  }

  std::unique_ptr<FeatureTrackerRos> tracker_;
};

}  // namespace vins::feature_tracker

PLUGINLIB_EXPORT_CLASS(vins::feature_tracker::FeatureTrackerNodelet, nodelet::Nodelet)
