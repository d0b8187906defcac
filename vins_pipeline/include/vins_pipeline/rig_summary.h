#pragma once

#include <string>

#include "vins_estimator/inertial/rig_calibration.h"

namespace vins::pipeline {

/// What was estimated of a rig, a line for each quantity, with one standard deviation; quantities
/// that were no variables are left out. Empty where there is none. `covariance`: of all errors, as
/// EstimatorResult has it.
std::string describeRig(const estimator::RigCalibration& rig,
                        const estimator::RigMatrix& covariance);

}  // namespace vins::pipeline
