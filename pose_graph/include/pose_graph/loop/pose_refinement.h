#pragma once

#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"

namespace vins::pose_graph {

/// A point of the query and its bearing in the old camera.
struct SeenPoint {
  Eigen::Vector3d point_q = Eigen::Vector3d::Zero();     ///< in the query's body frame [m]
  Eigen::Vector3d bearing_o = Eigen::Vector3d::UnitZ();  ///< unit vector, old camera's frame
};

/// The chord between a point's direction and its bearing, in the old camera's frame: as long as
/// the angle between them, where that is small [rad], and 2 where they are opposite. `T_oq` takes
/// the query's body frame to the old camera's. `J_error_pose`, which may be null, gets the
/// derivative by xi with T_oq exp(xi) (se3's order).
Eigen::Vector3d bearingError(const SeenPoint& seen, const Pose& T_oq,
                             Eigen::Matrix<double, 3, 6>* J_error_pose = nullptr);

/// The pose of six degrees of freedom with the least sum of Huber's loss of the errors, of
/// threshold `huber` [rad], by Gauss-Newton steps from `T_oq`, which is replaced. False where the
/// points do not determine it; then T_oq is as it was.
bool refinePose(const std::vector<SeenPoint>& points, double huber, Pose* T_oq);

}  // namespace vins::pose_graph
