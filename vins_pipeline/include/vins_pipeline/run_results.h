#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "vins_core/time.h"
#include "vins_core/trajectory.h"
#include "vins_estimator/estimator.h"
#include "vins_pipeline/pipeline.h"
#include "vins_pipeline/recording.h"

namespace vins::pipeline {

/// The trajectory of a run, pose by pose as each was known when its frame came, and what is to be
/// said of it.
class RunResults {
 public:
  void add(const PipelineResult& result);
  void add(const RecordedTruth& truth);
  /// Counts an event that no stage has made.
  void add(const Event& event);

  /// TUM's form: stamp [s] tx ty tz [m] qx qy qz qw, a line for each odometry.
  const std::string& vioLive() const { return vio_live_; }

  /// VINS-Mono's vins_result_no_loop.csv: stamp [ns], px,py,pz [m], qw,qx,qy,qz, vx,vy,vz [m/s],
  /// in the form of its files (a comma at the end of each line).
  const std::string& vinsMonoCsv() const { return vins_mono_csv_; }

  /// The truth of the same span in TUM's form; without the quaternions where only positions were
  /// measured. Empty where there is none.
  const std::string& groundTruth() const { return ground_truth_; }

  /// The poses at the IMU's time, stamp + td as it was known at each frame; ground truth is
  /// compared there. Nothing where td was 0 throughout.
  std::optional<Trajectory> atImuTime(const Trajectory& poses) const;

  std::size_t images() const { return images_; }
  std::size_t frames() const { return frames_; }
  std::size_t odometries() const { return odometries_; }

  /// The first odometry, in seconds since the first image; nothing while there is none.
  std::optional<double> initialisedAfter() const;

  /// The rig as estimated last, in words; empty where nothing of it was estimated.
  std::string rig() const;

  /// The newest frame has an odometry.
  bool isTracking() const { return status_ == estimator::EstimatorStatus::kTracking; }

  /// Sum of the distances between neighbouring positions of the same sequence [m].
  double pathLength() const { return path_length_; }

  /// Sequences beyond the first.
  unsigned resets() const { return resets_; }

  /// How often each event came, but for those that only inform.
  const std::map<std::string, std::size_t>& warnings() const { return warnings_; }

  /// For a progress bar: "148 features, tracking".
  std::string state() const;

 private:
  void add(const estimator::EstimatorResult& estimate);
  void add(const estimator::Odometry& odometry);

  std::map<Stamp, double> td_;  ///< by the image's stamp [s]
  std::string vio_live_;
  std::string vins_mono_csv_;
  std::string ground_truth_;
  std::size_t images_ = 0;
  std::size_t frames_ = 0;
  std::size_t odometries_ = 0;
  std::size_t features_ = 0;
  std::optional<Stamp> first_image_;
  std::optional<Stamp> first_odometry_;
  std::optional<Stamp> last_truth_;
  std::optional<estimator::Odometry> last_odometry_;
  estimator::RigCalibration rig_;  ///< the last
  estimator::RigMatrix rig_covariance_ = estimator::RigMatrix::Zero();
  estimator::EstimatorStatus status_ = estimator::EstimatorStatus::kInitializing;
  double path_length_ = 0.0;
  unsigned resets_ = 0;
  std::map<std::string, std::size_t> warnings_;
};

}  // namespace vins::pipeline
