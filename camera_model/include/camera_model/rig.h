#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "vins_core/imu.h"
#include "vins_core/parameters.h"
#include "vins_core/pose.h"

namespace vins::camera_model {

/// How far the cameras' poses in the body frame are known (estimate_extrinsic: 0, 1, 2).
enum class ExtrinsicMode {
  kTrusted,  ///< 0: as given
  kRefined,  ///< 1: given as a first guess
  kUnknown   ///< 2: to be found by moving
};

/// A camera of a rig.
struct RigCamera {
  std::shared_ptr<const Camera> camera;
  std::string image_topic;        ///< sensor_msgs/Image; empty where the file names none
  std::string camera_info_topic;  ///< sensor_msgs/CameraInfo; empty where the file names none
  bool is_from_topic = false;     ///< the file has no intrinsics, the topic gave them
  Pose T_bc;              ///< camera in the body frame; identity where the file does not give it
  double td = 0.0;        ///< time offset, t_imu = t_cam + td [s]
  double readout = 0.0;   ///< time in which all rows are read, rolling shutter; 0: global [s]
  std::string mask_file;  ///< image, black where no feature may be; empty: none
};

/// What the noise figures of a file were taken for.
enum class ImuNoiseUnit {
  kDensity,  ///< continuous time, as data sheets and Kalibr give them
  kSample    ///< deviations of one sample at the IMU's rate, as VINS-Mono means them
};

/// The inertial sensor of a rig. The body frame is the IMU's.
struct RigImu {
  std::string topic;  ///< sensor_msgs/Imu; empty where the file names none
  /// sensor_msgs/Imu of an accelerometer with a topic of its own: `topic` is then the gyroscope's.
  /// Empty: both come on `topic`.
  std::string accel_topic;
  ImuNoise noise;                              ///< always densities
  ImuNoiseUnit unit = ImuNoiseUnit::kDensity;  ///< of the figures in the file
  double rate = 200.0;                         ///< [Hz]
};

/// Cameras and IMU of a rig, with all that relates them in space and time.
struct Rig {
  std::string file;                ///< that it was read from
  std::vector<RigCamera> cameras;  ///< at least one; the first is the one that odometry goes by
  RigImu imu;
  ExtrinsicMode extrinsic = ExtrinsicMode::kTrusted;
  bool estimate_td = false;           ///< the time offset is a first guess
  std::vector<std::string> warnings;  ///< a line for each thing that a user should hear of

  /// The first camera's rotation in the body frame is known, so that the gyroscope predicts how its
  /// image turns. Not with ExtrinsicMode::kUnknown, whatever the file gives besides.
  bool rotationIsKnown() const { return extrinsic != ExtrinsicMode::kUnknown; }
};

/// Returns the camera that a topic of sensor_msgs/CameraInfo describes. Throws InputError where
/// there is none.
using CameraInfoReader = std::function<std::shared_ptr<const Camera>(const std::string& topic)>;

/// Reads the rig of a configuration file, in any of these forms:
///
/// - VINS-Mono's: the camera in the file itself, extrinsicRotation and extrinsicTranslation.
/// - VINS-Fusion's: num_of_cam, cam0_calib (a camera's file seen from this file's folder, or the
///   camera as a section), body_T_cam0, image0_topic, and the same of cam1.
/// - Kalibr's camchain-imucam: sections cam0, cam1, ... with T_cam_imu (body to camera),
///   timeshift_cam_imu (t_imu = t_cam + shift), rostopic; the IMU in a section imu0, or in Kalibr's
///   imu.yaml beside the file.
/// - OpenVINS's estimator_config.yaml with its relative_config_imu and relative_config_imucam, or
///   one of these chains alone; T_imu_cam is the camera's pose in the body.
/// - A file of a camera alone: the rest is taken as unknown.
///
/// A key at the top of the file goes before the same thing in a section. Rotations that are off by
/// up to 3 degrees are taken to the nearest rotation, noise of zero is raised to a floor, and what
/// a Kalibr or OpenVINS file lacks gets a default, each with a warning. Marks the keys that it
/// reads, or that other programs read and this one does not, as known to `parameters`. Where the
/// file has no intrinsics of the first camera but names a camera_info_topic, `read_camera_info`
/// gives them. Throws InputError naming file, key, what was found and what is allowed.
Rig readRig(const Parameters& parameters, const CameraInfoReader& read_camera_info = nullptr);

/// The same of the file at `path`.
Rig readRigFile(const std::string& path);

/// What a user should hear of a configuration file: the rig's warnings, then a line for each key at
/// the file's top that no stage knows. For the one program of several that tells.
std::vector<std::string> configurationWarnings(const Parameters& parameters, const Rig& rig);

/// Throws InputError, as Parameters do for a key that is missing, where the file names no topic of
/// the first camera, or of the IMU.
void requireImageTopic(const Parameters& parameters, const Rig& rig);
void requireImuTopic(const Parameters& parameters, const Rig& rig);

/// The rig as a configuration file that readRig() reads to the same rig: VINS-Mono's form, extended
/// by VINS-Fusion's for more cameras, which stand in the file as sections. Files are named by
/// absolute paths.
std::string toYaml(const Rig& rig);

}  // namespace vins::camera_model
