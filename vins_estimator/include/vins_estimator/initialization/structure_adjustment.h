#pragma once

#include <vector>

#include "vins_core/pose.h"
#include "vins_estimator/initialization/initial_landmarks.h"

namespace vins::estimator {

/// How an adjustment of a structure ended.
struct StructureAdjustment {
  bool usable = false;  ///< all finite, at least one landmark left
  double rms = 0.0;     ///< of the residuals per axis [deviations]
  int outliers = 0;     ///< sightings taken away
};

/// Bundle adjustment up to scale: poses and landmarks (hosted by cameras) with Huber's loss, then
/// without the sightings beyond `gate` [deviations]. The first pose stays; the scale, which nothing
/// tells, is free in the solver (whose damping holds it) and normalized in the end: the camera
/// farthest from the first is at distance one.
StructureAdjustment adjustStructure(int max_iterations, double gate, std::vector<Pose>* T_sc,
                                    std::vector<InitialLandmark>* landmarks);

}  // namespace vins::estimator
