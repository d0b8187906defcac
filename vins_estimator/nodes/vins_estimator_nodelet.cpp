#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "estimator_ros.h"
#include "vins_core/input_error.h"

namespace vins::estimator {

/// The estimator in a nodelet manager.
class EstimatorNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      estimator_ = std::make_unique<EstimatorRos>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;
    }
  }

  std::unique_ptr<EstimatorRos> estimator_;
};

}  // namespace vins::estimator

PLUGINLIB_EXPORT_CLASS(vins::estimator::EstimatorNodelet, nodelet::Nodelet)
