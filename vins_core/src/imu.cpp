#include "vins_core/imu.h"

#include "vins_core/option_check.h"

namespace vins {

ImuSample interpolate(const ImuSample& from, const ImuSample& to, Stamp stamp) {
  const double share = toSeconds(stamp - from.stamp) / toSeconds(to.stamp - from.stamp);
  ImuSample sample;
  sample.stamp = stamp;
  sample.acceleration = (1.0 - share) * from.acceleration + share * to.acceleration;
  sample.angular_velocity = (1.0 - share) * from.angular_velocity + share * to.angular_velocity;
  return sample;
}

void ImuNoise::validate() const {
  requirePositive("IMU noise", "acc_n", accelerometer_noise);
  requirePositive("IMU noise", "gyr_n", gyroscope_noise);
  requirePositive("IMU noise", "acc_w", accelerometer_walk);
  requirePositive("IMU noise", "gyr_w", gyroscope_walk);
  requirePositive("IMU noise", "g_norm", gravity);
  requireWithin("IMU noise", "vibration_share", vibration_share, {0.0, 1.0});
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
