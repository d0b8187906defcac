#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "vins_core/parameters.h"
#include "vins_core/pose.h"

namespace vins::feature_tracker {

/// Cameras and topics of a configuration file, as far as the feature tracker needs them.
struct RigConfiguration {
  std::string image_topic;         ///< image_topic, or image0_topic
  std::string second_image_topic;  ///< image1_topic; empty: one camera
  std::string imu_topic;           ///< imu_topic; empty: none
  std::vector<std::shared_ptr<const camera_model::Camera>> cameras;  ///< one or two
  std::vector<Pose> T_bc;       ///< of each; identity where not known
  double td = 0.0;              ///< t_imu = t_cam + td [s]
  bool rotation_known = false;  ///< the gyroscope's turns can be carried over to the camera
};

/// Reads VINS-Mono's form (the camera in the file itself, extrinsicRotation and
/// extrinsicTranslation; estimate_extrinsic: 2 means that these are not known), or VINS-Fusion's
/// for one or two cameras (cam0_calib, cam1_calib: camera files, seen from the configuration's
/// folder; body_T_cam0, body_T_cam1). A second camera is configured by image1_topic. Throws
/// InputError naming file, key, what was found and what is allowed.
RigConfiguration readRigConfiguration(const Parameters& parameters);

}  // namespace vins::feature_tracker
