#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace vins::camera_model {

/// A folder for the files of a rig, which ends with the test.
class RigFiles : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Writes a file into the folder. Returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path) << text;
    return path;
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("rig_files_" + std::to_string(getpid()));
};

/// Files of one rig in the forms of several programs: the camera looks along the body's z axis, its
/// x axis is the body's y axis, and it stands at (0.1, 0.2, 0.3) in the body frame.
namespace rig_files {

inline std::string camera(double fx = 458.5) {
  return "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: left\nimage_width: 752\n"
         "image_height: 480\ndistortion_parameters:\n   k1: -0.28\n   k2: 0.07\n   p1: 0.0002\n"
         "   p2: 1.8e-05\nprojection_parameters:\n   fx: " +
         std::to_string(fx) + "\n   fy: 457.25\n   cx: 367.5\n   cy: 248.0\n";
}

inline std::string noise() { return "acc_n: 0.08\ngyr_n: 0.004\nacc_w: 4.0e-5\ngyr_w: 2.0e-6\n"; }

inline std::string vinsMono() {
  return camera() + "imu_topic: \"/imu0\"\nimage_topic: \"/cam0/image_raw\"\n" +
         "estimate_extrinsic: 0\nextrinsicRotation: !!opencv-matrix\n   rows: 3\n   cols: 3\n"
         "   dt: d\n   data: [0, -1, 0,\n          1, 0, 0,\n          0, 0, 1]\n"
         "extrinsicTranslation: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n"
         "   data: [0.1, 0.2, 0.3]\ntd: -0.01\nestimate_td: 1\nrolling_shutter: 1\n"
         "rolling_shutter_tr: 0.03\ng_norm: 9.80\n" +
         noise();
}

/// Beside cam0.yaml, and cam1.yaml where there are two.
inline std::string vinsFusion(int cameras) {
  return "%YAML:1.0\nimu: 1\nnum_of_cam: " + std::to_string(cameras) +
         "\nimu_topic: \"/imu0\"\nimage0_topic: \"/left/image_raw\"\n"
         "image1_topic: \"/right/image_raw\"\noutput_path: \"~/output/\"\n"
         "cam0_calib: \"cam0.yaml\"\ncam1_calib: \"cam1.yaml\"\nimage_width: 752\n"
         "image_height: 480\nestimate_extrinsic: 1\nbody_T_cam0: !!opencv-matrix\n   rows: 4\n"
         "   cols: 4\n   dt: d\n   data: [0, -1, 0, 0.1,\n          1, 0, 0, 0.2,\n"
         "          0, 0, 1, 0.3,\n          0, 0, 0, 1]\nmultiple_thread: 1\nflow_back: 1\n" +
         (cameras < 2 ? ""
                      : "body_T_cam1: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n"
                        "   data: [0, -1, 0, 0.1,\n          1, 0, 0, 0.31,\n"
                        "          0, 0, 1, 0.3,\n          0, 0, 0, 1]\n") +
         "td: 0.005\nestimate_td: 0\n" + noise();
}

/// `pose`: the lines of T_cam_imu, T_imu_cam or T_cn_cnm1.
inline std::string chainCamera(int number, const std::string& pose) {
  const std::string name = std::to_string(number);
  return "cam" + name + ":\n" + pose +
         "  cam_overlaps: []\n  camera_model: pinhole\n"
         "  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.8e-05]\n  distortion_model: radtan\n"
         "  intrinsics: [458.5, 457.25, 367.5, 248.0]\n  resolution: [752, 480]\n"
         "  rostopic: /chain/cam" +
         name + "\n  timeshift_cam_imu: 0.007\n";
}

/// Kalibr's: the body's coordinates to the camera's, the inverse of the pose above.
inline std::string bodyToCamera() {
  return "  T_cam_imu:\n  - [0.0, 1.0, 0.0, -0.2]\n  - [-1.0, 0.0, 0.0, 0.1]\n"
         "  - [0.0, 0.0, 1.0, -0.3]\n  - [0.0, 0.0, 0.0, 1.0]\n";
}

/// OpenVINS's: the pose above itself.
inline std::string cameraToBody() {
  return "  T_imu_cam: #rotation from camera to IMU\n    - [0.0, -1.0, 0.0, 0.1]\n"
         "    - [1.0, 0.0, 0.0, 0.2]\n    - [0.0, 0.0, 1.0, 0.3]\n    - [0.0, 0.0, 0.0, 1.0]\n";
}

/// The second camera 0.11 m to the right of the first: coordinates of the first to its own.
inline std::string firstToSecond() {
  return "  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.11]\n  - [0.0, 1.0, 0.0, 0.0]\n"
         "  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n";
}

/// Kalibr's imu.yaml, of which each line begins with `indent`.
inline std::string kalibrImu(const std::string& indent = "") {
  return indent + "accelerometer_noise_density: 0.04\n" + indent +
         "accelerometer_random_walk: 0.003\n" + indent + "gyroscope_noise_density: 0.0002\n" +
         indent + "gyroscope_random_walk: 0.00002\n" + indent + "rostopic: /chain/imu\n" + indent +
         "update_rate: 400.0\n";
}

}  // namespace rig_files
}  // namespace vins::camera_model
