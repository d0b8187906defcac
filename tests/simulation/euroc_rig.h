#pragma once

#include <memory>

#include "camera_model/camera.h"
#include "vins_core/imu.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// EuRoC's VI-Sensor, by the sensor.yaml files of the data set (M. Burri et al., "The EuRoC micro
/// aerial vehicle datasets", IJRR 2016). Body = IMU.
Pose eurocCameraInBody(int camera);  ///< T_bc of cam0 or cam1

/// Intrinsics of cam0 or cam1.
std::unique_ptr<camera_model::Camera> eurocCamera(int camera);

/// Densities of imu0/sensor.yaml.
ImuNoise eurocImuNoise();

}  // namespace vins::simulation
