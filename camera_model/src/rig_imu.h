#pragma once

#include "camera_model/rig.h"
#include "rig_sources.h"

namespace vins::camera_model {

/// Reads the IMU of a rig.
///
/// VINS-Mono's keys are acc_n, gyr_n, acc_w and gyr_w. `imu_noise_unit` says what they are:
/// "density" (continuous time), "sample" (VINS-Mono's: the deviation of one sample at `imu_rate`),
/// or "auto" (default): sample where acc_n is above 0.03, which no usable sensor has as a density,
/// as VINS-Mono's own files (0.08 and more) have it. VINS-Mono adds acc_n n to a sample and
/// acc_w dt n to the bias in each step, with n a normal number: both are divided by sqrt(imu_rate).
/// Kalibr's and OpenVINS's keys, accelerometer_noise_density and so on, are always densities.
RigImu readRigImu(const RigSources& sources);

}  // namespace vins::camera_model
