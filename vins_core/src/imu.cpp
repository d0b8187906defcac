#include "vins_core/imu.h"

#include <cmath>
#include <sstream>

#include "vins_core/input_error.h"

namespace vins {
namespace {

void requirePositive(const char* key, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << "IMU noise: " << key << " is " << value << "; allowed: a number above 0";
  throw InputError(message.str());
}

}  // namespace

void ImuNoise::validate() const {
  requirePositive("acc_n", accelerometer_noise);
  requirePositive("gyr_n", gyroscope_noise);
  requirePositive("acc_w", accelerometer_walk);
  requirePositive("gyr_w", gyroscope_walk);
  requirePositive("g_norm", gravity);
  if (!(vibration_share >= 0.0 && vibration_share <= 1.0)) {
    throw InputError("IMU noise: vibration_share is " + std::to_string(vibration_share) +
                     "; allowed: 0 to 1");
  }
}

std::ostream& operator<<(std::ostream& out, const ImuNoise& noise) {
  return out << "acc_n: " << noise.accelerometer_noise << " m/s^2/sqrt(Hz)\n"
             << "gyr_n: " << noise.gyroscope_noise << " rad/s/sqrt(Hz)\n"
             << "acc_w: " << noise.accelerometer_walk << " m/s^3/sqrt(Hz)\n"
             << "gyr_w: " << noise.gyroscope_walk << " rad/s^2/sqrt(Hz)\n"
             << "g_norm: " << noise.gravity << " m/s^2\n"
             << "vibration_share: " << noise.vibration_share << "\n";
}

}  // namespace vins
