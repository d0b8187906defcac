#pragma once

#include <cstdint>

#include "simulation/recording_simulator.h"

namespace vins::simulation {

/// A walk through makeHousehold() with a consumer's device, as hard as life. The seed draws:
///
/// - the camera: 640 x 360 or (one in four) 1280 x 720, 66 to 74 degrees wide, little distortion
///   that its user does not know of; rolling shutter of 10 to 30 ms, which the user does not know
///   of either; automatic exposure of 5 to 30 ms; JPEG; 15 to 30 Hz with lost and late images;
/// - the IMU: BMI055 or BMI160 by its data sheet, up to twice as noisy, with errors of scale of up
/// to
///   a percent, an accelerometer with a rate of its own and irregular stamps; half of the users
///   configure the data sheet's noise, half double it;
/// - the calibration: focal length off by up to 1 %, extrinsic by some 2 degrees and 1 cm, and a
///   time offset of up to 0.1 s, of which the configuration says 0, to be estimated;
/// - the motion: from rest or in the middle of the walk.
///
/// Throws nothing; simulateRecording() judges the duration [s].
RecordingOptions householdRecording(std::uint64_t seed, double duration);

}  // namespace vins::simulation
