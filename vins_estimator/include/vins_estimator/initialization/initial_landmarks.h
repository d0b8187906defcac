#pragma once

#include <cstdint>
#include <vector>

#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include "vins_core/feature_frame.h"
#include "vins_core/pose.h"
#include "vins_estimator/factors/bearing_factor.h"
#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// A feature in the frames of an initialization.
struct InitialTrack {
  struct Sighting {
    std::size_t frame = 0;  ///< index
    const FeatureObservation* observation = nullptr;
  };
  std::int64_t id = 0;
  std::vector<Sighting> sightings;  ///< in the order of frames

  /// What `frame` saw of it; null where nothing.
  const FeatureObservation* in(std::size_t frame) const;
};

/// The tracks of the first camera that at least two frames see, by rising id; at most `max_tracks`
/// of them, those with most sightings. The frames must outlive them.
std::vector<InitialTrack> collectTracks(const std::vector<const FeatureFrame*>& frames,
                                        std::size_t max_tracks);

/// The measured bearing with its weight, for a deviation of `pixel_noise` [px].
BearingMeasurement toMeasurement(const FeatureObservation& observation, double pixel_noise);

/// A landmark of the first adjustment; its host is the frame of its first sighting.
struct InitialLandmark {
  struct Sighting {
    std::size_t frame = 0;  ///< index
    BearingMeasurement measured;
  };
  std::int64_t id = 0;
  LandmarkAnchor anchor;
  LandmarkParameters parameters = LandmarkParameters::Zero();
  std::vector<Sighting> sightings;

  std::size_t host() const { return sightings.front().frame; }
};

/// Poses (and motions) as an adjustment holds them. Neither vector may grow once a problem uses it.
struct InitialBlocks {
  std::vector<WindowState> states;   ///< the factors' references; no part of them is fixed
  std::vector<PoseBlock> poses;      ///< body in the world
  std::vector<MotionBlock> motions;  ///< velocities and biases

  explicit InitialBlocks(const std::vector<NavState>& values);
  std::vector<NavState> values() const;
};

/// Adds a residual for each sighting, and the landmarks as first group of the elimination. All
/// arguments must outlive the problem, which takes no ownership of `loss`. Returns the residuals'
/// names.
std::vector<ceres::ResidualBlockId> addLandmarkResiduals(const Pose& T_bc,
                                                         ceres::LossFunction* loss,
                                                         InitialBlocks* blocks,
                                                         std::vector<InitialLandmark>* landmarks,
                                                         ceres::Problem* problem,
                                                         ceres::ParameterBlockOrdering* ordering);

/// Norm of a sighting's residual [deviations].
double sightingResidual(const InitialLandmark& landmark, std::size_t sighting, const Pose& T_bc,
                        const InitialBlocks& blocks);

/// Takes away the sightings whose residual is beyond `gate` [deviations], and landmarks whose
/// host's sighting is among them, which keep fewer than two sightings, or which have no positive
/// distance. Returns how many sightings went.
int removeOutliers(double gate, const Pose& T_bc, const InitialBlocks& blocks,
                   std::vector<InitialLandmark>* landmarks);

/// Sum of the squares of the sightings' residuals [deviations^2].
double landmarkSquares(const Pose& T_bc, const InitialBlocks& blocks,
                       const std::vector<InitialLandmark>& landmarks);

/// Root mean square of the sightings' residuals per axis [deviations], allowing for the three
/// numbers of each landmark that were fitted to them.
double landmarkRms(const Pose& T_bc, const InitialBlocks& blocks,
                   const std::vector<InitialLandmark>& landmarks);

}  // namespace vins::estimator
