#pragma once

#include <ostream>

#include "vins_core/imu.h"
#include "vins_core/parameters.h"
#include "vins_core/pose.h"

namespace vins::estimator {

/// How far the camera's pose in the body frame is known (estimate_extrinsic: 0, 1, 2).
enum class ExtrinsicMode {
  kTrusted,  ///< 0: as given
  kRefined,  ///< 1: given as a first guess
  kUnknown   ///< 2: to be found by moving
};

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
  double rolling_shutter_readout = 0.0;  ///< of all rows (rolling_shutter_tr); 0: global [s]
  int image_height = 0;                  ///< needed with a rolling shutter [px]
  MotionOnly motion_only = MotionOnly::kWhenBehind;  ///< motion_only_ba

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const EstimatorOptions& options);

/// Reads the options from a rig's configuration file. The camera's pose is given by
/// extrinsicRotation and extrinsicTranslation, which may be absent where estimate_extrinsic is 2,
/// or by T_cam_imu (and td by timeshift_cam_imu) in a section cam0 as Kalibr's camchain has it.
/// Throws InputError naming file, key, what was found and what is allowed.
EstimatorOptions readEstimatorOptions(const Parameters& parameters);

/// Reads acc_n, gyr_n, acc_w, gyr_w and g_norm. `imu_noise_unit` says what the four densities are:
/// "density" (continuous time, as Kalibr's and data sheets), "sample" (VINS-Mono's: the deviation
/// of one sample at `imu_rate`), or "auto" (default): sample where acc_n is above 0.03, which no
/// usable sensor has as a density, as VINS-Mono's own files (0.08 and more) have it. VINS-Mono adds
/// acc_n n to a sample and acc_w dt n to the bias in each step, with n a normal number: the
/// densities are both divided by sqrt(imu_rate). Where acc_n is absent, Kalibr's keys are taken,
/// always densities: accelerometer_noise_density, accelerometer_random_walk,
/// gyroscope_noise_density, gyroscope_random_walk, at the top or in a section imu0.
ImuNoise readImuNoise(const Parameters& parameters);

}  // namespace vins::estimator
