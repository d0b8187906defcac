#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/visual_inertial_alignment.h"
#include "vins_estimator/initialization/visual_structure.h"

namespace vins::estimator {

/// Why an attempt at initialization has failed, as an event says it: code, what is the matter and
/// what to do, figures.
struct WaitingReason {
  const char* code = nullptr;
  std::string text;
  std::vector<std::pair<std::string, double>> figures;
};

/// What images and IMU were like in the time of an attempt: by these figures the likeliest of
/// several causes is told.
struct InputFigures {
  int features = 0;           ///< in the newest frame, of the first camera
  double lasting = 1.0;       ///< share of a frame's features that the next one has, mean
  double turn_rate = 0.0;     ///< norm of the gyroscope's readings, mean [rad/s]
  double imu_period = 0.0;    ///< between two samples, median [s]
  double image_period = 0.0;  ///< between two frames, mean [s]
};

/// The figures of frames that follow one another, the oldest first.
InputFigures figuresOf(const std::deque<SharedMeasurements>& measurements);

/// Of a newest frame that too few features connect with the ones before: few features at all, or
/// many that do not last, because the camera turns fast, images come rarely or are blurred.
WaitingReason explainFewTracks(const InputFigures& inputs);

/// Of a structure that is not ok().
WaitingReason explain(const VisualStructure& structure, const InputFigures& inputs);

/// Of an alignment that is not ok().
WaitingReason explain(const Alignment& alignment, const InputFigures& inputs);

}  // namespace vins::estimator
