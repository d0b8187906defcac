#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "vins_core/feature_frame.h"
#include "vins_core/pose.h"
#include "vins_estimator/initialization/camera_resection.h"
#include "vins_estimator/initialization/initial_landmarks.h"
#include "vins_estimator/initialization/relative_pose.h"

namespace vins::estimator {

/// Options of buildStructure().
struct VisualStructureOptions {
  int min_shared = 20;               ///< features that the pair shares, at least one more
  double min_parallax = 10.0;        ///< of the pair, compensated by the gyroscope: median [px]
  double min_own_parallax = 2.5;     ///< what the best rotation leaves of it: median [px]
  double max_gyroscope_bias = 0.2;   ///< beyond it, images and gyroscope disagree [rad/s]
  double rotation_tolerance = 0.05;  ///< the same, independent of time [rad]
  int max_pairs = 3;                 ///< tried
  int max_tracks = 100;              ///< used, the longest ones
  double outlier_gate = 3.5;         ///< of a sighting after the adjustment [deviations]
  double max_rms = 1.5;              ///< of the residuals in the end, per axis [deviations]
  int min_landmarks = 20;            ///< in the end
  int max_iterations = 12;           ///< of an adjustment
  RelativePoseOptions relative_pose;
  ResectionOptions resection;

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// A frame, and how the camera has turned since the first frame of the list by the gyroscope.
struct StructureFrame {
  const FeatureFrame* features = nullptr;
  Eigen::Quaterniond R_c0_c = Eigen::Quaterniond::Identity();
};

enum class StructureStatus {
  kOk,
  kFewTracks,       ///< no older frame shares enough features with the newest
  kLittleParallax,  ///< the camera has not moved enough for its distance from the scene
  kNoRelativePose,  ///< no epipolar geometry that the gyroscope agrees with
  kLostFrame,       ///< a frame between sees too little of the structure
  kBadAdjustment    ///< what the adjustment leaves is no rigid scene
};

const char* toString(StructureStatus status);

/// Camera poses and landmarks up to a scale: in the frame s of the first camera, the camera
/// farthest from it at distance one. With another status than kOk, only the figures.
struct VisualStructure {
  StructureStatus status = StructureStatus::kFewTracks;
  std::vector<Pose> T_sc;                  ///< one for each frame, the first one identity
  std::vector<InitialLandmark> landmarks;  ///< of unit extrinsic: hosts are cameras
  int shared = 0;                          ///< features that the best pair shares
  double parallax = 0.0;                   ///< of that pair, compensated by the gyroscope [px]
  double own_parallax = 0.0;               ///< of that pair, what the best rotation leaves [px]
  double rms = 0.0;                        ///< of the residuals per axis [deviations]

  bool ok() const { return status == StructureStatus::kOk; }
};

/// Structure from motion over frames (oldest first): five-point RANSAC on the newest and an older
/// frame, triangulation, resection of the others, triangulation of more, bundle adjustment with a
/// robust loss, rejection of outliers, adjustment. `pixel_noise`: deviation of a corner per axis
/// [px]. The same for the same `seed`.
VisualStructure buildStructure(const std::vector<StructureFrame>& frames, double pixel_noise,
                               const VisualStructureOptions& options, std::uint64_t seed);

}  // namespace vins::estimator
