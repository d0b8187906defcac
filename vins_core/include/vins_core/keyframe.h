#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins {

/// A landmark as a keyframe sees it.
struct KeyframePoint {
  std::int64_t id = 0;                                   ///< of the feature track
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       ///< [px]
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();    ///< unit vector in the camera frame
  Eigen::Vector3d position_w = Eigen::Vector3d::Zero();  ///< in the odometry's world frame [m]
};

/// A frame that the estimator has chosen to keep, handed to the pose graph.
struct Keyframe {
  std::int64_t id = 0;         ///< counts keyframes in a run, resets do not restart it
  std::uint32_t sequence = 0;  ///< rises when the estimator resets or the recording restarts
  Stamp stamp = 0;             ///< [ns]
  Stamp chosen_at = 0;         ///< of the frame with which it became a keyframe [ns]
  Pose T_wb;                   ///< body in the odometry's world frame
  Pose T_bc;                   ///< camera in the body frame, as estimated then
  Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< of T_wb: position [m], rotation [rad], right
  std::vector<KeyframePoint> points;
  /// Counts the frames that the odometry has been in. A reset that carries the last state over
  /// begins a sequence in the same world; a restart begins one at a new origin.
  std::uint32_t world = 0;
};

/// The pose with which a keyframe left the estimator's window: its last word on it.
struct KeyframePoseUpdate {
  std::int64_t keyframe_id = 0;
  std::uint32_t sequence = 0;
  Stamp stamp = 0;  ///< [ns]
  Pose T_wb;
};

}  // namespace vins
