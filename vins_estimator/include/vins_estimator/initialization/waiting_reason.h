#pragma once

#include <string>
#include <utility>
#include <vector>

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

/// Of a newest frame that too few features connect with the ones before.
WaitingReason explainFewTracks(int features);

/// Of a structure that is not ok().
WaitingReason explain(const VisualStructure& structure);

/// Of an alignment that is not ok().
WaitingReason explain(const Alignment& alignment);

}  // namespace vins::estimator
