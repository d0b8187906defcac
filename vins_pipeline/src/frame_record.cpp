#include "vins_pipeline/frame_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Core>

namespace vins::pipeline {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// Standard deviations from variances; those that rounding made negative are zero.
Eigen::Vector3d deviations(const Eigen::Matrix3d& covariance) {
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

FrameRecord::FrameRecord()
    : tracker_csv_("#stamp [ns],before,tracked,inliers,detected,mean_track_length\n"),
      estimator_csv_(
          "#stamp [ns],sequence,landmarks,outliers,keyframe,sigma_px [m],sigma_py [m],"
          "sigma_pz [m],sigma_yaw [deg],sigma_tilt [deg],sigma_vx [m/s],sigma_vy [m/s],"
          "sigma_vz [m/s],td [s],sigma_td [s]\n") {}

void FrameRecord::add(const PipelineResult& result) {
  const feature_tracker::TrackerStatistics& tracker = result.tracker;
  char line[160];
  std::snprintf(line, sizeof(line), "%lld,%d,%d,%d,%d,%.3f\n", static_cast<long long>(result.stamp),
                tracker.before, tracker.tracked, tracker.inliers, tracker.detected,
                tracker.mean_track_length);
  tracker_csv_ += line;
  for (const estimator::EstimatorResult& estimate : result.estimates) {
    if (estimate.odometry) add(*estimate.odometry, estimate);
  }
}

void FrameRecord::add(const estimator::Odometry& odometry,
                      const estimator::EstimatorResult& result) {
  const estimator::EstimatorStatistics& statistics = result.statistics;
  const Eigen::Matrix3d R_wb = odometry.state.T_wb.rotation.toRotationMatrix();
  const estimator::Matrix15d& P = odometry.covariance;
  const Eigen::Vector3d position =
      deviations(P.block<3, 3>(estimator::kPosition, estimator::kPosition));
  // The rotation's error is one of the body's axes.
  const Eigen::Vector3d turn =
      deviations(R_wb * P.block<3, 3>(estimator::kRotation, estimator::kRotation) *
                 R_wb.transpose()) /
      kDegree;
  const Eigen::Vector3d velocity =
      deviations(P.block<3, 3>(estimator::kVelocity, estimator::kVelocity));
  char line[320];
  std::snprintf(line, sizeof(line),
                "%lld,%u,%d,%d,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n",
                static_cast<long long>(odometry.stamp), odometry.sequence, statistics.landmarks,
                statistics.outliers, statistics.keyframe ? 1 : 0, position.x(), position.y(),
                position.z(), turn.z(), turn.head<2>().norm(), velocity.x(), velocity.y(),
                velocity.z(), result.rig.td, std::sqrt(std::max(0.0, result.rig_covariance(6, 6))));
  estimator_csv_ += line;
}

}  // namespace vins::pipeline
