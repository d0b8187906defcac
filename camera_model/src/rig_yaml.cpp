#include <filesystem>
#include <sstream>

#include "camera_model/camera_file.h"
#include "camera_model/rig.h"
#include "vins_core/yaml_text.h"

namespace vins::camera_model {
namespace {

std::string quoted(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return "\"" + escaped + "\"";
}

/// A line, unless there is nothing to say.
std::string textLine(const std::string& key, const std::string& text) {
  return text.empty() ? "" : key + ": " + quoted(text) + "\n";
}

std::string numberLine(const std::string& key, double value) {
  return key + ": " + exactNumber(value) + "\n";
}

/// The camera's lines without YAML's head, each indented.
std::string sectionOf(const Camera& camera) {
  std::istringstream lines(toCamodocalYaml(camera));
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line[0] != '%' && line != "---") section += "   " + line + "\n";
  }
  return section;
}

std::string topicsText(const Rig& rig) {
  std::string text = textLine("imu_topic", rig.imu.topic) +
                     textLine("accel_topic", rig.imu.accel_topic) +
                     textLine("image_topic", rig.cameras[0].image_topic) +
                     textLine("camera_info_topic", rig.cameras[0].camera_info_topic);
  return text.empty() ? "" : "\n# Topics\n" + text;
}

std::string poseText(const Rig& rig) {
  const Pose& T_bc = rig.cameras[0].T_bc;
  return "\n# Camera in the body (IMU) frame, p_b = R p_c + t. 0: trust it, 1: refine it, 2: find "
         "it\nestimate_extrinsic: " +
         std::to_string(static_cast<int>(rig.extrinsic)) + "\n" +
         opencvMatrix("extrinsicRotation", T_bc.rotation.toRotationMatrix()) +
         opencvMatrix("extrinsicTranslation", T_bc.position);
}

std::string timeText(const Rig& rig) {
  const RigCamera& camera = rig.cameras[0];
  return "\n# Time: t_imu = t_cam + td [s]; read-out of all rows [s]\n" +
         numberLine("td", camera.td) + "estimate_td: " + std::to_string(rig.estimate_td) +
         "\nrolling_shutter: " + std::to_string(camera.readout > 0.0) + "\n" +
         numberLine("rolling_shutter_tr", camera.readout);
}

std::string imuText(const Rig& rig) {
  const ImuNoise& noise = rig.imu.noise;
  return "\n# IMU: continuous-time densities [m/s^2/sqrt(Hz)], [rad/s/sqrt(Hz)], "
         "[m/s^3/sqrt(Hz)], [rad/s^2/sqrt(Hz)]\nimu_noise_unit: density\n" +
         numberLine("acc_n", noise.accelerometer_noise) +
         numberLine("gyr_n", noise.gyroscope_noise) +
         numberLine("acc_w", noise.accelerometer_walk) + numberLine("gyr_w", noise.gyroscope_walk) +
         numberLine("imu_rate", rig.imu.rate) + numberLine("g_norm", noise.gravity) +
         numberLine("vibration_share", noise.vibration_share);
}

std::string maskText(const Rig& rig) {
  const std::string& mask = rig.cameras[0].mask_file;
  if (mask.empty()) return "";
  return "\nfisheye: 1\n" + textLine("fisheye_mask", std::filesystem::absolute(mask).string());
}

std::string furtherCamerasText(const Rig& rig) {
  if (rig.cameras.size() < 2) return "";
  std::string text =
      "\n# Further cameras\nnum_of_cam: " + std::to_string(rig.cameras.size()) + "\n";
  for (std::size_t i = 1; i < rig.cameras.size(); ++i) {
    const std::string number = std::to_string(i);
    const RigCamera& camera = rig.cameras[i];
    text += textLine("image" + number + "_topic", camera.image_topic) +
            numberLine("td" + number, camera.td) +
            opencvMatrix("body_T_cam" + number, camera.T_bc.matrix()) + "cam" + number +
            "_calib:\n" + sectionOf(*camera.camera);
  }
  return text;
}

}  // namespace

std::string toYaml(const Rig& rig) {
  // YAML's head comes with the camera, which therefore stands first.
  return toCamodocalYaml(*rig.cameras[0].camera) + topicsText(rig) + poseText(rig) + timeText(rig) +
         imuText(rig) + maskText(rig) + furtherCamerasText(rig);
}

}  // namespace vins::camera_model
