#include "part_options.h"

namespace vins::estimator {

InitializerOptions initializerOptions(const EstimatorOptions& options) {
  InitializerOptions result;
  result.imu = options.imu;
  result.T_bc = options.T_bc;
  result.pixel_noise = options.pixel_noise;
  result.stillness.gravity = options.imu.gravity;
  result.max_frames = options.window_size + 1;
  return result;
}

ImuPlausibilityOptions plausibilityOptions(const EstimatorOptions& options) {
  ImuPlausibilityOptions result;
  result.gravity = options.imu.gravity;
  if (options.extrinsic != ExtrinsicMode::kUnknown) result.R_bc = options.T_bc.rotation;
  return result;
}

MeasurementQueueOptions queueOptions() {
  MeasurementQueueOptions options;
  options.max_frames = 200;  // ten seconds without the IMU
  return options;
}

TurnCalibratorOptions calibratorOptions(const EstimatorOptions& options) {
  TurnCalibratorOptions result;
  result.pixel_noise = options.pixel_noise;
  if (options.extrinsic == ExtrinsicMode::kUnknown) result.prior.rotation_sigma = 0.0;
  if (options.extrinsic == ExtrinsicMode::kRefined) {
    result.prior.rotation_sigma = options.extrinsic_rotation_sigma;
  }
  if (options.estimate_td) result.prior.td_sigma = options.td_sigma;
  return result;
}

RigCheckOptions rigCheckOptions(const EstimatorOptions& options) {
  RigCheckOptions result;
  const auto add = [&](RigPart part, bool is_estimated) {
    (is_estimated ? result.estimated : result.suspects).push_back(part);
  };
  const bool estimates_extrinsic = options.extrinsic != ExtrinsicMode::kTrusted;
  add(RigPart::kTranslation, estimates_extrinsic);
  add(RigPart::kRotation, estimates_extrinsic);
  add(RigPart::kTimeOffset, options.estimate_td);
  add(RigPart::kReadout, options.estimate_readout);
  add(RigPart::kFocalLength, options.estimate_intrinsics);
  return result;
}

}  // namespace vins::estimator
