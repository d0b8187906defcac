#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "camera_model/camera.h"
#include "vins_core/imu.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// What a user is told about a camera-IMU rig.
struct Rig {
  std::vector<std::shared_ptr<const camera_model::Camera>> cameras;
  std::vector<Pose> T_bc;                ///< of each camera
  ImuNoise noise;                        ///< as a filter should assume it
  double time_offset = 0.0;              ///< td [s]
  double rolling_shutter_readout = 0.0;  ///< first row to the one below the last [s]
  bool estimate_extrinsic = false;       ///< the extrinsic is only a first guess
  bool estimate_time_offset = false;     ///< and so is td
  bool self_calibration = false;         ///< and so are read-out, intrinsics and the IMU's axes
};

/// The rig as a calibration with errors would hand it out. Each number gets a normal error with a
/// deviation of `sigmas` times: focal lengths 0.1 %, principal point 0.5 px, every other intrinsic
/// parameter 1 % of its value, extrinsic rotation 0.2 degrees and translation 2 mm per axis. The
/// same for the same seed. Throws InputError where `sigmas` is negative.
Rig withCalibrationError(const Rig& rig, double sigmas, std::uint64_t seed);

/// A configuration in VINS-Mono's form for one camera of the rig, which records topics as EuRoC's
/// bags have them (/cam0/image_raw, /imu0).
std::string toVinsYaml(const Rig& rig, std::size_t camera);

}  // namespace vins::simulation
