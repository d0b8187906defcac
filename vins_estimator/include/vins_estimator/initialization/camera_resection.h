#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"

namespace vins::estimator {

/// A known point on a measured ray.
struct PointSighting {
  Eigen::Vector3d position_s = Eigen::Vector3d::Zero();  ///< in the structure's frame
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();    ///< unit, in the camera
  double inverse_sigma = 460.0;                          ///< [1/rad]
};

struct ResectionOptions {
  int min_points = 12;       ///< that agree in the end
  double min_inliers = 0.5;  ///< share of the sightings
  double inlier_gate = 5.0;  ///< [deviations]; the points have errors of their own
  double robust = 3.0;       ///< residuals beyond it pull with constant force [deviations]
  int max_iterations = 20;

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// Pose T_sc of a camera that sees these points (PnP): damped Gauss-Newton on the tangent planes of
/// the bearings, with Huber's loss, from `start` on, which may be off by some tenths of the scene's
/// distance. Nothing where too few sightings agree with it.
std::optional<Pose> resectCamera(const std::vector<PointSighting>& sightings, const Pose& start,
                                 const ResectionOptions& options = {});

}  // namespace vins::estimator
