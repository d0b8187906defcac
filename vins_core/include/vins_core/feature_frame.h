#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vins_core/time.h"

namespace vins {

/// One tracked corner in one image.
struct FeatureObservation {
  std::int64_t id = 0;   ///< the track's, unique in a run; the same in both cameras of a rig
  int camera = 0;        ///< 0, or 1 for the second camera of a stereo rig
  int track_length = 1;  ///< images it has been seen in, this one included
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();             ///< as measured, distorted [px]
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();          ///< unit vector in the camera frame
  Eigen::Vector3d bearing_velocity = Eigen::Vector3d::Zero();  ///< [1/s]; zero if not known
  double angular_resolution = 1.0 / 460.0;  ///< angle that one pixel spans there [rad/px]

  /// The velocity needs the image before: a new track has none.
  bool hasVelocity() const { return track_length > 1; }
};

/// What the feature tracker saw in one image (or pair of images).
struct FeatureFrame {
  Stamp stamp = 0;             ///< the image's, in the camera's clock [ns]
  std::uint32_t sequence = 0;  ///< counts images since the start; a hole is a dropped frame
  std::vector<FeatureObservation> observations;
};

}  // namespace vins
