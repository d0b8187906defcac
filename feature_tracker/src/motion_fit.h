#pragma once

#include <array>
#include <vector>

#include "feature_tracker/outlier_rejection.h"

namespace vins::feature_tracker {

/// Distances of many pairs from their epipolar planes, for one motion after the other. Its single
/// precision is good for a hundredth of a pixel.
class EpipolarTable {
 public:
  /// Takes other pairs.
  void assign(const std::vector<BearingPair>& pairs);

  /// Squares of epipolarDistance() of all pairs [px^2], in their order.
  void squaredDistances(const RelativeMotion& motion, std::vector<float>* squares);

 private:
  // A column for each pair's coordinate or constant, so that several pairs are computed at once.
  using Column = Eigen::ArrayXf;
  std::array<Column, 3> first_, second_;
  Column squared_resolution_, least_;
  std::array<Column, 3> normal_;  ///< kept from call to call, so that nothing is allocated
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

}  // namespace vins::feature_tracker
