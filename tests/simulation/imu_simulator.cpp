#include "simulation/imu_simulator.h"

#include <cmath>
#include <string>

#include "simulation/random.h"
#include "vins_core/option_check.h"

namespace vins::simulation {
namespace {

constexpr int kSinusoids = 8;

/// One sinusoid of a vibration, in all six channels.
struct Sinusoid {
  double frequency = 0.0;  ///< [Hz]
  Eigen::Vector3d acceleration, acceleration_phase;
  Eigen::Vector3d angular_velocity, angular_phase;
};

Eigen::Vector3d randomPhases(Random* random) {
  const double x = random->uniform(), y = random->uniform(), z = random->uniform();
  return 2.0 * M_PI * Eigen::Vector3d(x, y, z);
}

std::vector<Sinusoid> makeSinusoids(const std::vector<Vibration>& vibrations, std::uint64_t seed) {
  Random random(seed, "imu vibration");
  // The mean square of a sinusoid is half of its squared amplitude.
  const double share = std::sqrt(2.0 / kSinusoids);
  std::vector<Sinusoid> sinusoids;
  for (const Vibration& vibration : vibrations) {
    for (int i = 0; i < kSinusoids; ++i) {
      Sinusoid sinusoid;
      sinusoid.frequency = vibration.frequency + vibration.bandwidth * random.uniform(-0.5, 0.5);
      sinusoid.acceleration = Eigen::Vector3d::Constant(share * vibration.acceleration);
      sinusoid.acceleration_phase = randomPhases(&random);
      sinusoid.angular_velocity = Eigen::Vector3d::Constant(share * vibration.angular_velocity);
      sinusoid.angular_phase = randomPhases(&random);
      sinusoids.push_back(sinusoid);
    }
  }
  return sinusoids;
}

Eigen::Vector3d oscillation(const Eigen::Vector3d& amplitude, double frequency, double t,
                            const Eigen::Vector3d& phase) {
  const Eigen::Array3d angle = 2.0 * M_PI * frequency * t + phase.array();
  return (amplitude.array() * angle.sin()).matrix();
}

/// The noise-free reading at a time of the trajectory.
ImuSample idealSample(const TrajectorySpline& trajectory, double t, double gravity,
                      const std::vector<Sinusoid>& sinusoids) {
  const MotionState state = trajectory.at(t);
  const Eigen::Vector3d g_w(0.0, 0.0, -gravity);
  ImuSample sample;
  sample.acceleration = state.T_wb.rotation.conjugate() * (state.acceleration_w - g_w);
  sample.angular_velocity = state.angular_velocity_b;
  for (const Sinusoid& s : sinusoids) {
    sample.acceleration += oscillation(s.acceleration, s.frequency, t, s.acceleration_phase);
    sample.angular_velocity += oscillation(s.angular_velocity, s.frequency, t, s.angular_phase);
  }
  return sample;
}

void requireAtLeastZero(const std::string& name, double value) {
  if (!std::isfinite(value) || value < 0.0)
    refuseOption("simulated IMU", name, value, "a number of at least 0");
}

}  // namespace

void ImuOptions::validate() const {
  if (!(rate >= 1.0 && rate <= 1e5)) refuseOption("simulated IMU", "rate", rate, "1 to 100000 Hz");
  if (!(std::abs(time_offset) <= 1.0))
    refuseOption("simulated IMU", "time offset", time_offset, "-1 to 1 s");
  if (!initial_accelerometer_bias.allFinite() || !initial_gyroscope_bias.allFinite()) {
    refuseOption("simulated IMU", "initial bias", NAN, "finite numbers");
  }
  noise.validate();
  for (const Vibration& vibration : vibrations) {
    requireAtLeastZero("vibration frequency", vibration.frequency);
    requireAtLeastZero("vibration bandwidth", vibration.bandwidth);
    requireAtLeastZero("vibration acceleration", vibration.acceleration);
    requireAtLeastZero("vibration angular velocity", vibration.angular_velocity);
  }
}

std::ostream& operator<<(std::ostream& out, const ImuOptions& options) {
  out << "rate: " << options.rate << " Hz\n"
      << "noise: " << (options.noise_free ? "none" : "as follows") << "\n"
      << options.noise
      << "initial accelerometer bias: " << options.initial_accelerometer_bias.transpose()
      << " m/s^2\n"
      << "initial gyroscope bias: " << options.initial_gyroscope_bias.transpose() << " rad/s\n"
      << "time offset: " << options.time_offset << " s\n";
  for (const Vibration& v : options.vibrations) {
    out << "vibration: " << v.frequency << " Hz +- " << v.bandwidth / 2 << ", " << v.acceleration
        << " m/s^2, " << v.angular_velocity << " rad/s\n";
  }
  return out;
}

ImuRecording simulateImu(const TrajectorySpline& trajectory, Stamp first, Stamp last,
                         const ImuOptions& options, std::uint64_t seed) {
  options.validate();
  Random white(seed, "imu white noise");
  Random walk(seed, "imu bias walk");
  const auto sinusoids = makeSinusoids(options.vibrations, seed);
  const double white_scale = options.noise_free ? 0.0 : std::sqrt(options.rate);
  const double walk_scale = options.noise_free ? 0.0 : 1.0 / std::sqrt(options.rate);
  ImuBias bias{first, options.initial_accelerometer_bias, options.initial_gyroscope_bias};
  ImuRecording recording;
  for (std::int64_t i = 0;; ++i) {
    bias.stamp = first + toNanoseconds(static_cast<double>(i) / options.rate);
    if (bias.stamp > last) return recording;
    const double t = trajectory.secondsAt(bias.stamp) - options.time_offset;
    ImuSample sample = idealSample(trajectory, t, options.noise.gravity, sinusoids);
    sample.stamp = bias.stamp;
    sample.acceleration +=
        bias.accelerometer + options.noise.accelerometer_noise * white_scale * white.normal3();
    sample.angular_velocity +=
        bias.gyroscope + options.noise.gyroscope_noise * white_scale * white.normal3();
    recording.samples.push_back(sample);
    recording.biases.push_back(bias);
    bias.accelerometer += options.noise.accelerometer_walk * walk_scale * walk.normal3();
    bias.gyroscope += options.noise.gyroscope_walk * walk_scale * walk.normal3();
  }
}

}  // namespace vins::simulation
