#pragma once

#include "vins_estimator/estimator_options.h"
#include "vins_estimator/health/imu_plausibility.h"
#include "vins_estimator/health/rig_check.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/extrinsic_rotation.h"
#include "vins_estimator/initialization/initializer.h"

namespace vins::estimator {

/// Options of the estimator's parts, composed from its own.
InitializerOptions initializerOptions(const EstimatorOptions& options);
MeasurementQueueOptions queueOptions();
ImuPlausibilityOptions plausibilityOptions(const EstimatorOptions& options);
TurnCalibratorOptions calibratorOptions(const EstimatorOptions& options);
RigCheckOptions rigCheckOptions(const EstimatorOptions& options);

}  // namespace vins::estimator
