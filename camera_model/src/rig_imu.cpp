#include "rig_imu.h"

#include <array>
#include <cmath>
#include <sstream>

namespace vins::camera_model {
namespace {

constexpr Range kDensity{0.0, 100.0};
constexpr Range kGravity{9.0, 10.5};  ///< [m/s^2]
constexpr Range kRate{10.0, 10000.0};
constexpr double kSampleAbove = 0.03;  ///< no density of a usable accelerometer is [m/s^2/sqrt(Hz)]
constexpr double kNone = 1e-9;         ///< below, a density counts as zero

/// A density and its names.
struct NoiseKey {
  const char* vins;
  const char* kalibr;
  double ImuNoise::*value;
  double fallback;  ///< a middling sensor's, with the margin that vibration asks for
  double floor;     ///< a very good sensor's: zero would let the filter trust it for ever
};

constexpr std::array<NoiseKey, 4> kNoiseKeys = {{
    {"acc_n", "accelerometer_noise_density", &ImuNoise::accelerometer_noise, 0.01, 1e-4},
    {"gyr_n", "gyroscope_noise_density", &ImuNoise::gyroscope_noise, 0.001, 1e-5},
    {"acc_w", "accelerometer_random_walk", &ImuNoise::accelerometer_walk, 2e-4, 1e-6},
    {"gyr_w", "gyroscope_random_walk", &ImuNoise::gyroscope_walk, 2e-5, 1e-7},
}};

std::string textOf(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void raiseToFloor(const Parameters& parameters, const std::string& key, double floor,
                  double* value) {
  if (*value >= kNone) return;
  *value = floor;
  parameters.remark(key, "key '" + key + "' is 0, which no sensor has: " + textOf(floor) +
                             " is taken (as a density)");
}

void readVinsNoise(const Parameters& parameters, RigImu* imu) {
  const std::string unit =
      parameters.textOr("imu_noise_unit", "auto", {"auto", "density", "sample"});
  for (const NoiseKey& key : kNoiseKeys) {
    imu->noise.*key.value = parameters.number(key.vins, kDensity);
  }
  const bool is_sample =
      unit == "sample" || (unit == "auto" && imu->noise.accelerometer_noise > kSampleAbove);
  imu->unit = is_sample ? ImuNoiseUnit::kSample : ImuNoiseUnit::kDensity;
  for (const NoiseKey& key : kNoiseKeys) {
    double& value = imu->noise.*key.value;
    if (is_sample) value /= std::sqrt(imu->rate);
    raiseToFloor(parameters, key.vins, key.floor, &value);
  }
}

void readKalibrNoise(const Parameters& parameters, RigImu* imu) {
  std::string missing;
  for (const NoiseKey& key : kNoiseKeys) {
    double& value = imu->noise.*key.value;
    value = parameters.numberOr(key.kalibr, key.fallback, kDensity);
    raiseToFloor(parameters, key.kalibr, key.floor, &value);
    if (parameters.has(key.kalibr)) continue;
    missing += (missing.empty() ? "" : ", ") + std::string(key.kalibr) + " " + textOf(value);
  }
  if (!missing.empty()) {
    parameters.remark("imu0", "noise of the IMU that is not given: taken is " + missing);
  }
}

void readNoise(const RigSources& sources, RigImu* imu) {
  const Parameters& main = sources.main;
  const bool is_vins = main.has("acc_n") || main.has("gyr_n") || main.has("acc_w") ||
                       main.has("gyr_w") || (!sources.imu && !sources.is_incomplete_by_form);
  const bool is_kalibr_at_top = !main.has("acc_n") && main.has("accelerometer_noise_density");
  if (is_vins && !is_kalibr_at_top) return readVinsNoise(main, imu);
  main.textOr("imu_noise_unit", "auto", {"auto", "density", "sample"});
  readKalibrNoise(sources.imu.value_or(main), imu);
}

}  // namespace

RigImu readRigImu(const RigSources& sources) {
  const Parameters& main = sources.main;
  const Parameters& own = sources.imu.value_or(main);
  RigImu imu;
  imu.topic = main.textOr("imu_topic", own.textOr("rostopic", ""));
  imu.accel_topic = main.textOr("accel_topic", "");
  imu.rate = main.numberOr("imu_rate", own.numberOr("update_rate", imu.rate, kRate), kRate);
  readNoise(sources, &imu);
  imu.noise.gravity =
      main.numberOr("g_norm", main.numberOr("gravity_mag", imu.noise.gravity, kGravity), kGravity);
  imu.noise.vibration_share =
      main.numberOr("vibration_share", imu.noise.vibration_share, {0.0, 1.0});
  return imu;
}

}  // namespace vins::camera_model
