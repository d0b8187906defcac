#pragma once

#include <cmath>
#include <memory>

#include "camera_model/testing/example_cameras.h"
#include "simulation/image_options.h"
#include "simulation/scene_catalogue.h"
#include "vins_core/pose.h"
#include "vins_core/so3.h"

namespace vins::simulation {

/// The room, built once for a test program: it takes a second.
inline std::shared_ptr<const Scene> sharedRoom() {
  static const auto room = std::make_shared<const Scene>(makeScene("room", 1));
  return room;
}

/// T_bc of a camera at the body's origin that looks along the body's x axis, with z up.
inline Pose centredCamera() {
  Eigen::Matrix3d R_bc;
  R_bc << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Pose(Eigen::Quaterniond(R_bc), Eigen::Vector3d::Zero());
}

/// The same with a lever arm.
inline Pose forwardCamera() {
  return Pose(centredCamera().rotation, Eigen::Vector3d(0.05, 0.02, -0.01));
}

/// T_wb on a loop through the room's free space at up to 0.8 m/s, turning at up to 0.8 rad/s about
/// all axes.
inline Pose roomTrajectory(double t_s) {
  const Eigen::Vector3d p_w(1.4 * std::cos(0.5 * t_s), 0.9 * std::sin(0.5 * t_s),
                            1.5 + 0.3 * std::sin(0.9 * t_s));
  const double yaw = 0.4 * t_s + 0.5 * std::sin(0.7 * t_s);
  const Eigen::Vector3d tilt(0.1 * std::sin(1.1 * t_s), 0.15 * std::sin(1.3 * t_s), 0.0);
  return Pose(so3::exp(Eigen::Vector3d(0, 0, yaw)) * so3::exp(tilt), p_w);
}

/// Options without noise, vignetting and blackouts; the lens blur and the exposure remain.
inline ImageOptions noiseFree() {
  ImageOptions options;
  options.vignetting = 0.0;
  options.full_well_electrons = 0.0;
  options.read_noise_dn = 0.0;
  return options;
}

}  // namespace vins::simulation
