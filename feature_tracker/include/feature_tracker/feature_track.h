#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "feature_tracker/anchored_patch.h"

namespace vins::feature_tracker {

/// Where a camera sees a tracked point, and how that moves.
struct TrackSight {
  cv::Point2f pixel;                                           ///< [px]
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();          ///< unit vector, camera frame
  Eigen::Vector3d bearing_velocity = Eigen::Vector3d::Zero();  ///< [1/s]
  double angular_resolution = 1.0;                             ///< [rad/px]
  int images = 1;  ///< in a row that have seen it, this one included
};

/// A corner followed through the images.
struct FeatureTrack {
  static constexpr std::uint32_t kMemory = 16;  ///< images whose bearings are remembered

  std::int64_t id = 0;
  TrackSight sight;                           ///< in the first camera
  AnchoredPatch patch;                        ///< as it looked at first
  std::array<Eigen::Vector3d, kMemory> past;  ///< bearing in image i at past[i % kMemory]
  std::optional<TrackSight> second;           ///< in the second camera of a rig
  Eigen::Vector2d drift{0.0, 0.0};            ///< motion on top of the predicted turn [px/s]
};

inline Eigen::Vector2d toEigen(const cv::Point2f& pixel) { return {pixel.x, pixel.y}; }

inline cv::Point2f toPoint(const Eigen::Vector2d& pixel) {
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
}

}  // namespace vins::feature_tracker
