#pragma once

#include <vector>

#include "feature_tracker/outlier_rejection.h"

namespace vins {

/// Distances from epipolar planes for one motion and many pairs.
class EpipolarMeasure {
 public:
  explicit EpipolarMeasure(const RelativeMotion& motion)
      : R_21_(motion.R_21.toRotationMatrix()), t_21_(motion.t_21) {}

  /// Square of epipolarDistance() [px^2].
  double squaredDistance(const BearingPair& pair) const;

 private:
  Eigen::Matrix3d R_21_;
  Eigen::Vector3d t_21_;
};

/// One least-squares step of a camera's motion on pairs of bearings.
struct MotionFitOptions {
  double sigma = 0.1;           ///< of good pairs' distances to their planes [px]
  double scale = 1.0;           ///< distance where a pair begins to count less [px]; or infinite
  double rotation_sigma = 1.0;  ///< of the rotation's prior about R_prior [rad]
  Eigen::Quaterniond R_prior = Eigen::Quaterniond::Identity();
};

/// A Gauss-Newton step on rotation (3) and direction of translation (2), where pairs at many times
/// the scale count next to nothing (weights of S. Geman, D. McClure, "Statistical methods for
/// tomographic image reconstruction", 1987). `sample` are the pairs that count; all pairs where it
/// is empty. Leaves `motion` as it is where the equations are singular.
void stepMotion(const std::vector<BearingPair>& pairs, const std::vector<std::size_t>& sample,
                const MotionFitOptions& options, RelativeMotion* motion);

/// The rotation that explains the pairs best if there is no translation, from R_21 on: robust
/// against a minority that has parallax or is wrong.
Eigen::Quaterniond fitRotation(const std::vector<BearingPair>& pairs,
                               const Eigen::Quaterniond& R_21);

/// Turns t_21 round where most of the pairs would else lie behind the camera.
void faceForward(const std::vector<BearingPair>& pairs, double threshold, RelativeMotion* motion);

}  // namespace vins
