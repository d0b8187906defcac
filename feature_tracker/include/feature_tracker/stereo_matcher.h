#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "camera_model/camera.h"
#include "feature_tracker/feature_track.h"
#include "feature_tracker/optical_flow.h"
#include "vins_core/pose.h"

namespace vins::feature_tracker {

/// Finds the tracks of the first camera in the second camera of a calibrated stereo rig.
class StereoMatcher {
 public:
  /// T_10: takes points of the first camera's frame to the second's. `threshold` [px] is allowed
  /// as distance to the epipolar plane.
  StereoMatcher(std::shared_ptr<const camera_model::Camera> second, const Pose& T_10,
                double threshold, const OpticalFlowOptions& options);

  /// Fills FeatureTrack::second, from images of the same time, and clears it where the track is
  /// not found, off its epipolar plane, or behind the rig. `interval` [s] is the time since the
  /// last call, for velocities. Returns how many were found.
  int match(const ImagePyramid& first, const ImagePyramid& second, double interval,
            std::vector<FeatureTrack>* tracks);

 private:
  double medianInverseDepth(const std::vector<FeatureTrack>& tracks) const;
  double inverseDepth(const FeatureTrack& track) const;
  cv::Point2f predict(const FeatureTrack& track, double typical_inverse_depth) const;
  bool look(const FeatureTrack& track, const cv::Point2f& pixel, double interval,
            TrackSight* sight) const;

  std::shared_ptr<const camera_model::Camera> camera_;
  Pose T_10_;
  double threshold_;
  OpticalFlow flow_;
  std::vector<cv::Point2f> points_, matched_;
  std::vector<std::uint8_t> found_;
};

}  // namespace vins::feature_tracker
