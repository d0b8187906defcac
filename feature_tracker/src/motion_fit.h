#pragma once

#include <vector>

#include "feature_tracker/outlier_rejection.h"

namespace vins {

/// One least-squares step of a camera's motion on pairs of bearings.
struct MotionFitOptions {
  double threshold = 1.0;       ///< pairs further from the epipolar plane do not count [px]
  double rotation_sigma = 1.0;  ///< of the rotation's prior about R_prior [rad]
  Eigen::Quaterniond R_prior = Eigen::Quaterniond::Identity();
};

/// A Gauss-Newton step on rotation (3) and direction of translation (2). `sample` are the pairs
/// that count; all pairs where it is empty. Leaves `motion` as it is where the equations are
/// singular.
void stepMotion(const std::vector<BearingPair>& pairs, const std::vector<std::size_t>& sample,
                const MotionFitOptions& options, RelativeMotion* motion);

/// The rotation that explains the pairs best if there is no translation, from R_21 on: robust
/// against a minority that has parallax or is wrong.
Eigen::Quaterniond fitRotation(const std::vector<BearingPair>& pairs,
                               const Eigen::Quaterniond& R_21);

/// Turns t_21 round where most of the pairs would else lie behind the camera.
void faceForward(const std::vector<BearingPair>& pairs, double threshold, RelativeMotion* motion);

}  // namespace vins
