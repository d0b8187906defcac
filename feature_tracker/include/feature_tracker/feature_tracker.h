#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "feature_tracker/tracker_options.h"
#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/pose.h"

namespace vins::feature_tracker {

/// What one image did to the tracks of the first camera.
struct TrackerStatistics {
  int before = 0;                  ///< tracks of the image before
  int tracked = 0;                 ///< of them, found by optical flow and its way back
  int inliers = 0;                 ///< of them, left after the outlier rejection
  int detected = 0;                ///< new tracks
  int stereo = 0;                  ///< tracks that the second camera sees too
  double inlier_ratio = 1.0;       ///< inliers / tracked; 1 where nothing was tracked
  double mean_track_length = 0.0;  ///< of all tracks, new ones included [images]
  bool turn_measured = false;      ///< the gyroscope predicted the tracks
  bool equalized = false;          ///< CLAHE was applied
};

/// What comes of one image. Events by their codes: image_refused, image_late, image_gap,
/// tracker_restarted, tracking_lost, tracking_resumed.
struct FeatureTrackerResult {
  /// Absent where the image was refused, or `frequency` skips it. May have few observations or
  /// none, when there is nothing to see.
  std::optional<FeatureFrame> frame;
  std::vector<Event> events;
  TrackerStatistics statistics;
  bool restarted = false;  ///< time jumped back: consumers should restart
};

/// The steps of track(), in their order.
enum class TrackerStage { kPyramid, kTracking, kRejection, kDetection, kStereo };

/// The front end: finds corners and follows them from image to image. Reads no clock and no file,
/// starts no thread; the same calls after construction give the same results, bit for bit.
class FeatureTracker {
 public:
  /// One camera, or two of a stereo rig, with their poses in the body frame: the prediction by the
  /// gyroscope turns by R_bc. `mask` is CV_8UC1 of the first camera's size, 0 where no corner may
  /// be; or empty. Throws InputError for options that are out of range, another number of cameras
  /// or of poses, and a mask of another size.
  FeatureTracker(std::vector<std::shared_ptr<const camera_model::Camera>> cameras,
                 std::vector<Pose> T_bc, const FeatureTrackerOptions& options, cv::Mat mask = {});
  ~FeatureTracker();
  FeatureTracker(FeatureTracker&&) noexcept;
  FeatureTracker& operator=(FeatureTracker&&) noexcept;

  /// Takes the next image: CV_8UC1, one per camera; the second may be missing or empty. `imu`:
  /// samples since the image before up to this one, stamped by the camera's clock or close to it;
  /// may be empty. Never throws for bad images, samples or stamps: they are refused with an event.
  FeatureTrackerResult track(const std::vector<cv::Mat>& images, Stamp stamp,
                             const std::vector<ImuSample>& imu);

  /// Drops all tracks and the memory of time. Ids go on counting: none is ever used twice.
  void reset();

  /// `observer` is called at the end of each stage, for those who measure.
  void observeStages(std::function<void(TrackerStage)> observer);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vins::feature_tracker
