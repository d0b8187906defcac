#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/feature_frame.h"
#include "vins_core/pose.h"

namespace vins::estimator {

/// A track in two images.
struct BearingPair {
  Eigen::Vector3d first = Eigen::Vector3d::UnitZ();   ///< unit, in the first camera
  Eigen::Vector3d second = Eigen::Vector3d::UnitZ();  ///< unit, in the second
  double sigma = 1.0 / 460.0;                         ///< of either, per axis [rad]
};

/// The bearings of the features that both frames' first cameras see, in the second frame's order.
/// `pixel_noise`: deviation of a corner per axis [px].
std::vector<BearingPair> sharedBearings(const FeatureFrame& first, const FeatureFrame& second,
                                        double pixel_noise);

struct RelativePoseOptions {
  double inlier_gate = 3.0;   ///< distance from the epipolar plane [deviations]
  double min_inliers = 0.5;   ///< share of the pairs
  int max_iterations = 200;   ///< of RANSAC
  double confidence = 0.999;  ///< that one sample was free of outliers
  int refinements = 5;        ///< Gauss-Newton steps on the inliers

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

struct RelativePose {
  Pose T_12;                  ///< the second camera in the first; the distance is one
  std::vector<bool> inliers;  ///< one for each pair
  int inlier_count = 0;
};

/// Distance of a pair from epipolar geometry, to first order, with its sign [deviations]:
/// P. D. Sampson's, on the unit sphere.
double epipolarResidual(const Eigen::Matrix3d& E, const BearingPair& pair);

/// Relative poses by five-point RANSAC with local refinement: the best one, and perhaps a second
/// that explains the pairs nearly as well by another rotation, as planar scenes have it (only more
/// views tell them apart). Only poses whose rotation lies within `max_angle` [rad] of `R_12_gyro`
/// are taken, with the scene before both cameras. The same for the same `seed`. Empty where too few
/// pairs agree.
std::vector<RelativePose> findRelativePoses(const std::vector<BearingPair>& pairs,
                                            const Eigen::Quaterniond& R_12_gyro, double max_angle,
                                            const RelativePoseOptions& options, std::uint64_t seed);

/// The rotation R_12 that brings the second bearings nearest to the first, from `start` on, with a
/// robust loss.
Eigen::Quaterniond fitRotation(const std::vector<BearingPair>& pairs,
                               const Eigen::Quaterniond& start);

/// Median angle, over the pairs, between the first bearing and the second turned by R_12, in
/// deviations of a bearing.
double medianParallax(const std::vector<BearingPair>& pairs, const Eigen::Quaterniond& R_12);

}  // namespace vins::estimator
