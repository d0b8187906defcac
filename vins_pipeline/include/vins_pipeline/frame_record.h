#pragma once

#include <string>

#include "vins_estimator/estimator.h"
#include "vins_pipeline/pipeline.h"

namespace vins::pipeline {

/// What the tracker and the estimator had at each frame of a run, as tables: for figures, and for
/// whoever needs the covariance. The same input gives the same bytes: no times of work are in it.
class FrameRecord {
 public:
  FrameRecord();

  void add(const PipelineResult& result);

  /// tracker.csv, a line for each image: stamp [ns]; tracks of the image before, those of them that
  /// were found again and that passed the outlier rejection, new ones, and the mean length of all
  /// [images]. All are 0 where the image was refused.
  const std::string& trackerCsv() const { return tracker_csv_; }

  /// estimator.csv, a line for each odometry: stamp [ns], sequence, landmarks and rejected
  /// observations of the window, 1 for a keyframe, and standard deviations: of the position in the
  /// odometry's world [m], of yaw about its z and of tilt about its x and y together [deg], of the
  /// velocity along its axes [m/s]; last the time offset td and its standard deviation [s], 0 where
  /// it is not estimated.
  const std::string& estimatorCsv() const { return estimator_csv_; }

 private:
  void add(const estimator::Odometry& odometry, const estimator::EstimatorResult& result);

  std::string tracker_csv_;
  std::string estimator_csv_;
};

}  // namespace vins::pipeline
