#pragma once

#include <ostream>

#include "camera_model/rig.h"
#include "vins_core/imu.h"
#include "vins_core/parameters.h"
#include "vins_core/pose.h"

namespace vins::estimator {

using camera_model::ExtrinsicMode;

/// When only the newest frames are adjusted instead of the window (motion_only_ba: 0, 1, 2).
enum class MotionOnly {
  kNever,      ///< 0
  kAlways,     ///< 1: with every frame that makes no keyframe, for slow machines
  kWhenBehind  ///< 2: while frames wait for the estimator, so that it catches up
};

/// Options of the estimator, in VINS-Mono's names where it has them.
struct EstimatorOptions {
  ImuNoise imu;
  Pose T_bc;                        ///< camera in the body frame (extrinsicRotation, -Translation)
  double td = 0.0;                  ///< t_imu = t_cam + td [s]
  double pixel_noise = 0.5;         ///< deviation of a tracked corner, per axis [px]
  int window_size = 10;             ///< keyframes kept
  double keyframe_parallax = 10.0;  ///< rotation-compensated, for a new keyframe [px]
  int min_tracks = 10;              ///< below this, tracking counts as lost
  int max_num_iterations = 8;       ///< of a window's solution
  double max_solver_time = 0.0;     ///< [s]; 0: no bound. A safety net of the live node
  bool first_estimates = true;      ///< first-estimates Jacobians; off only to study them
  ExtrinsicMode extrinsic = ExtrinsicMode::kTrusted;  ///< estimate_extrinsic
  bool estimate_td = false;                           ///< td is a first guess
  double extrinsic_rotation_sigma = 0.05;             ///< of a guess of T_bc, per axis [rad]
  double extrinsic_translation_sigma = 0.05;          ///< the same [m]
  double td_sigma = 0.02;                             ///< of a guess of td [s]
  bool estimate_readout = false;                      ///< rolling_shutter_tr is a first guess
  bool estimate_intrinsics = false;      ///< focal lengths, principal point, distortion as well
  bool estimate_imu_intrinsics = false;  ///< scale and misalignment of the IMU's axes
  double readout_sigma = 0.01;           ///< of a guess of the read-out [s]
  double focal_length_sigma = 0.01;      ///< relative
  double principal_point_sigma = 0.01;   ///< over the focal length
  double distortion_sigma = 0.02;        ///< of k1 and k2
  double imu_intrinsics_sigma = 0.01;    ///< of each scale and misalignment of the IMU's axes
  double rolling_shutter_readout = 0.0;  ///< of all rows (rolling_shutter_tr); 0: global [s]
  int image_height = 0;                  ///< needed with a rolling shutter [px]
  MotionOnly motion_only = MotionOnly::kWhenBehind;  ///< motion_only_ba

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const EstimatorOptions& options);

/// Takes what describes the rig (IMU noise, extrinsic, time offset, read-out) from `rig`, of its
/// first camera, and the estimator's own keys from the configuration file. Throws InputError naming
/// file, key, what was found and what is allowed.
EstimatorOptions readEstimatorOptions(const Parameters& parameters, const camera_model::Rig& rig);

}  // namespace vins::estimator
