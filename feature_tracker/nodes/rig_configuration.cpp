#include "rig_configuration.h"

#include <filesystem>

#include "camera_model/camera_file.h"

namespace vins::feature_tracker {
namespace {

std::shared_ptr<const camera_model::Camera> cameraOf(const Parameters& parameters,
                                                     const std::string& key) {
  const std::filesystem::path folder = std::filesystem::path(parameters.name()).parent_path();
  return camera_model::readCameraFile((folder / parameters.text(key)).string());
}

Pose poseOf(const Parameters& parameters, const std::string& key) {
  return poseFromMatrix(parameters.matrix(key, 4, 4));
}

void readFirstPose(const Parameters& parameters, RigConfiguration* rig) {
  rig->T_bc.emplace_back();
  const bool unknown = parameters.integerOr("estimate_extrinsic", 0, {0, 2}) == 2;
  if (unknown) return;
  if (parameters.has("body_T_cam0")) {
    rig->T_bc[0] = poseOf(parameters, "body_T_cam0");
  } else if (parameters.has("extrinsicRotation")) {
    Eigen::Matrix4d T_bc = Eigen::Matrix4d::Identity();
    T_bc.topLeftCorner<3, 3>() = parameters.matrix("extrinsicRotation", 3, 3);
    if (parameters.has("extrinsicTranslation")) {
      T_bc.topRightCorner<3, 1>() = parameters.matrix("extrinsicTranslation", 3, 1);
    }
    rig->T_bc[0] = poseFromMatrix(T_bc);
  } else {
    return;
  }
  rig->rotation_known = true;
}

}  // namespace

RigConfiguration readRigConfiguration(const Parameters& parameters) {
  RigConfiguration rig;
  rig.image_topic =
      parameters.text(parameters.has("image0_topic") ? "image0_topic" : "image_topic");
  rig.second_image_topic = parameters.textOr("image1_topic", "");
  rig.imu_topic = parameters.textOr("imu_topic", "");
  rig.cameras.push_back(parameters.has("cam0_calib") ? cameraOf(parameters, "cam0_calib")
                                                     : std::shared_ptr<const camera_model::Camera>(
                                                           camera_model::readCamera(parameters)));
  rig.td = parameters.numberOr("td", 0.0, {-10.0, 10.0});
  readFirstPose(parameters, &rig);
  if (!rig.second_image_topic.empty()) {
    rig.cameras.push_back(cameraOf(parameters, "cam1_calib"));
    rig.T_bc.push_back(poseOf(parameters, "body_T_cam1"));
  }
  return rig;
}

}  // namespace vins::feature_tracker
