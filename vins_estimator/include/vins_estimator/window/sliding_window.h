#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_core/time.h"
#include "vins_estimator/factors/prior_factor.h"
#include "vins_estimator/factors/zero_motion_factor.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"
#include "vins_estimator/inertial/rig_calibration.h"
#include "vins_estimator/visual/landmarks.h"

namespace vins::estimator {

/// One frame of the window.
struct WindowFrame {
  FrameId id = 0;
  Stamp stamp = 0;  ///< the image's [ns]
  WindowState state;
  Preintegration imu;             ///< from the frame before it in the window
  std::int64_t keyframe_id = -1;  ///< not negative where it has become a keyframe
  bool stands_still = false;      ///< images and IMU say so
  bool has_rested = false;        ///< since the frame before it in the window
  double td = 0.0;                ///< with which it was timed [s]
  double readout = 0.0;           ///< rolling shutter undone beforehand [s]
  double interval = 0.0;          ///< since the image before it, 0: not known [s]
  Eigen::Vector3d measured_rate = Eigen::Vector3d::Zero();  ///< of the gyroscope, then [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< then [rad/s^2], body frame
  Matrix15d covariance = Matrix15d::Zero();  ///< of its state when it was the newest
};

/// A keyframe of long ago that sees what the window sees: a loop. Where it stands in the odometry's
/// world is unknown but for roll and pitch, since the odometry has drifted: with its pose as one
/// more unknown the loop tells the window about the landmarks and the pose graph about the drift,
/// but makes no jump.
struct OldKeyframe {
  std::int64_t keyframe_id = 0;
  std::int64_t query_id = 0;  ///< the window's keyframe that found it
  Pose T_wb;                  ///< in the odometry's world; its camera stands in it as rig.T_bc
  Pose T_body_old;            ///< from its own body frame to the one of T_wb: the rig's may differ
  Eigen::Vector3d up_b = Eigen::Vector3d::UnitZ();  ///< the vertical in T_wb's body frame, known
  std::map<std::int64_t, BearingMeasurement> measured;  ///< by the track's id
};

/// Values of a window's unknowns, but for the landmarks'.
struct WindowValues {
  std::vector<NavState> states;  ///< of the frames
  std::vector<Pose> old;         ///< T_wb of old keyframes: none or one
  RigCalibration rig;
};

/// All that the adjustment is about: frames, oldest first, their landmarks, and the prior that is
/// left of what has gone.
struct SlidingWindow {
  std::vector<WindowFrame> frames;
  Landmarks landmarks{1.0};
  Prior prior;  ///< its parts name frames by their index here
  RigCalibration rig;
  bool refines_rig = false;    ///< the rig is one of the unknowns; its prior says how far
  RigVariables rig_variables;  ///< which of its errors, where it is
  RigMatrix rig_covariance = RigMatrix::Identity();  ///< of its errors, as last known
  std::optional<OldKeyframe> loop;
  Eigen::Vector3d g_w = Eigen::Vector3d(0.0, 0.0, -9.81);
  ZeroMotionNoise rest;     ///< of frames that stand still
  double old_tilt = 0.005;  ///< deviation of an old keyframe's roll and pitch [rad]

  /// The present ones.
  WindowValues values() const;
  /// State of the body when a frame's image was taken, as the present td has it: the frame's own
  /// state is that of the time that its td said.
  NavState atImage(const WindowFrame& frame) const;
  /// Index of a frame; it must be there.
  std::size_t indexOf(FrameId id) const;
  /// T_wc of every frame.
  CameraPoses cameras() const;
};

/// A pose `late` seconds later, at constant rates: position [m/s], rotation [rad/s, body frame].
Pose carried(const Pose& T_wb, const Eigen::Matrix<double, 6, 1>& rate, double late);

/// Mean rates of a frame's body in this state, over `late` seconds from the frame's time on.
Eigen::Matrix<double, 6, 1> bodyRate(const WindowFrame& frame, const NavState& state, double late);

/// Takes a frame out that the prior does not touch: its visual measurements go, its IMU interval
/// becomes part of the next frame's.
void dropFrame(SlidingWindow* window, std::size_t index);

}  // namespace vins::estimator
