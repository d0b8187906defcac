#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_core/time.h"
#include "vins_estimator/factors/prior_factor.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"
#include "vins_estimator/visual/landmarks.h"

namespace vins {

/// One frame of the window.
struct WindowFrame {
  FrameId id = 0;
  Stamp stamp = 0;  ///< the image's [ns]
  WindowState state;
  Preintegration imu;                        ///< from the frame before it in the window
  std::int64_t keyframe_id = -1;             ///< not negative where it has become a keyframe
  bool stands_still = false;                 ///< images and IMU say so
  Matrix15d covariance = Matrix15d::Zero();  ///< of its state when it was the newest
};

/// All that the adjustment is about: frames, oldest first, their landmarks, and the prior that is
/// left of what has gone.
struct SlidingWindow {
  std::vector<WindowFrame> frames;
  Landmarks landmarks{1.0};
  Prior prior;  ///< its parts name frames by their index here
  Pose T_bc;
  Eigen::Vector3d g_w = Eigen::Vector3d(0.0, 0.0, -9.81);
  double still_velocity = 0.01;  ///< deviation of the velocity of frames that stand still [m/s]

  /// Index of a frame; it must be there.
  std::size_t indexOf(FrameId id) const;
  /// T_wc of every frame.
  CameraPoses cameras() const;
};

/// Takes a frame out that the prior does not touch: its visual measurements go, its IMU interval
/// becomes part of the next frame's.
void dropFrame(SlidingWindow* window, std::size_t index);

}  // namespace vins
