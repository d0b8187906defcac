#pragma once

#include <cstddef>

#include "vins_core/event.h"
#include "vins_core/time.h"
#include "vins_estimator/health/rig_error.h"

namespace vins::estimator {

/// Says which part of the rig is wrong, by how much at least (two deviations below the estimate),
/// and what to do. `windows`: how many the explanation is from.
Event rigEvent(Stamp stamp, const RigExplanation& explanation, std::size_t windows);

/// Says that an earlier finding no longer holds.
Event rigAgreesEvent(Stamp stamp);

}  // namespace vins::estimator
