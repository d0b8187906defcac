#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins {

/// A feature of the window, found again in an old keyframe.
struct MatchedFeature {
  std::int64_t id = 0;                                     ///< of the feature track in the window
  Eigen::Vector3d bearing_old = Eigen::Vector3d::UnitZ();  ///< in the old keyframe's camera frame
};

/// A verified loop, from the pose graph to the estimator: the window's keyframe `query_id` sees
/// what the old keyframe `old_id` saw. The window adjusts the old pose, too: position and yaw.
struct LoopMatch {
  std::int64_t query_id = 0;
  std::int64_t old_id = 0;
  Stamp query_stamp = 0;  ///< [ns]
  Pose T_wb_old;          ///< the old keyframe's body pose, in the odometry's world frame
  Pose T_bc_old;          ///< the old keyframe's camera in its body frame
  Pose T_old_query;       ///< relative body pose found by the verification: a first guess
  std::vector<MatchedFeature> features;
};

/// The relative pose refined by the estimator, back to the pose graph: a loop edge.
struct LoopEdge {
  std::int64_t query_id = 0;
  std::int64_t old_id = 0;
  Stamp query_stamp = 0;  ///< [ns]
  Pose T_old_query;       ///< body of the query keyframe in the body frame of the old one
  Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< of T_old_query: position [m], rotation [rad]
  int inliers = 0;                          ///< matched features that agree after the adjustment
};

}  // namespace vins
