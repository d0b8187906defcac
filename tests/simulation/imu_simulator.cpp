#include "simulation/imu_simulator.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "simulation/random.h"
#include "vins_core/option_check.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

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

/// The reading without bias and noise, with the errors of scale and alignment.
class IdealImu {
 public:
  IdealImu(const TrajectorySpline& trajectory, const ImuOptions& options, std::uint64_t seed)
      : trajectory_(trajectory),
        options_(options),
        sinusoids_(makeSinusoids(options.vibrations, seed)) {}

  /// At a stamp of the IMU's clock.
  ImuSample at(Stamp stamp) const {
    const double t = trajectory_.secondsAt(stamp) - options_.time_offset;
    const MotionState state = trajectory_.at(t);
    const Vector3d g_w(0.0, 0.0, -options_.noise.gravity);
    ImuSample sample;
    sample.stamp = stamp;
    sample.acceleration = state.T_wb.rotation.conjugate() * (state.acceleration_w - g_w);
    sample.angular_velocity = state.angular_velocity_b;
    for (const Sinusoid& s : sinusoids_) {
      sample.acceleration += oscillation(s.acceleration, s.frequency, t, s.acceleration_phase);
      sample.angular_velocity += oscillation(s.angular_velocity, s.frequency, t, s.angular_phase);
    }
    sample.acceleration = options_.accelerometer_gain * sample.acceleration;
    sample.angular_velocity = options_.gyroscope_gain * sample.angular_velocity;
    return sample;
  }

 private:
  const TrajectorySpline& trajectory_;
  const ImuOptions& options_;
  std::vector<Sinusoid> sinusoids_;
};

/// An accelerometer that samples at its own rate, read at other instants by interpolation.
class OwnAccelerometer {
 public:
  OwnAccelerometer(const IdealImu& ideal, const ImuOptions& options, Stamp first, Stamp last,
                   std::uint64_t seed)
      : period_s_(1.0 / options.accelerometer_rate) {
    Random random(seed, "accelerometer's own samples");
    const double deviation =
        options.noise_free ? 0.0 : options.noise.accelerometer_noise * std::sqrt(1.0 / period_s_);
    begin_ = first - toNanoseconds(random.uniform(0.1, 0.9) * period_s_);
    for (std::int64_t i = 0; samples_.empty() || stampOf(i - 1) < last; ++i) {
      samples_.push_back(ideal.at(stampOf(i)).acceleration + deviation * random.normal3());
    }
  }

  Vector3d at(Stamp stamp) const {
    const double place = toSeconds(stamp - begin_) / period_s_;
    const auto i = std::min(static_cast<std::size_t>(place), samples_.size() - 2);
    const double share = place - static_cast<double>(i);
    return (1.0 - share) * samples_[i] + share * samples_[i + 1];
  }

 private:
  Stamp stampOf(std::int64_t i) const {
    return begin_ + toNanoseconds(static_cast<double>(i) * period_s_);
  }

  double period_s_;
  Stamp begin_ = 0;
  std::vector<Vector3d> samples_;
};

/// Stamp of sample i; jitter is held to less than half a period, so that stamps rise.
Stamp instantOf(std::int64_t i, Stamp first, const ImuOptions& options, Random* random) {
  double t = static_cast<double>(i) / options.rate;
  if (options.stamp_jitter_s > 0.0) {
    const double most = 0.45 / options.rate;
    const double jitter = std::clamp(options.stamp_jitter_s * random->normal(), -most, most);
    if (i > 0) t += jitter;
  }
  return first + toNanoseconds(t);
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
  if (!accelerometer_gain.allFinite() || !gyroscope_gain.allFinite()) {
    refuseOption("simulated IMU", "gain", NAN, "finite numbers");
  }
  requireAtLeastZero("accelerometer's own rate", accelerometer_rate);
  requireAtLeastZero("jitter of stamps", stamp_jitter_s);
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
  if (options.accelerometer_rate > 0.0) {
    out << "accelerometer's own rate: " << options.accelerometer_rate << " Hz\n";
  }
  if (!options.accelerometer_gain.isIdentity() || !options.gyroscope_gain.isIdentity()) {
    out << "accelerometer gain:\n"
        << options.accelerometer_gain << "\ngyroscope gain:\n"
        << options.gyroscope_gain << "\n";
  }
  for (const Vibration& v : options.vibrations) {
    out << "vibration: " << v.frequency << " Hz +- " << v.bandwidth / 2 << ", " << v.acceleration
        << " m/s^2, " << v.angular_velocity << " rad/s\n";
  }
  return out;
}

ImuRecording simulateImu(const TrajectorySpline& trajectory, Stamp first, Stamp last,
                         const ImuOptions& options, std::uint64_t seed) {
  options.validate();
  const IdealImu ideal(trajectory, options, seed);
  Random white(seed, "imu white noise");
  Random walk(seed, "imu bias walk");
  Random jitter(seed, "imu jitter");
  std::optional<OwnAccelerometer> own;
  if (options.accelerometer_rate > 0.0) own.emplace(ideal, options, first, last, seed);
  const double white_scale = options.noise_free ? 0.0 : std::sqrt(options.rate);
  const double walk_scale = options.noise_free ? 0.0 : 1.0 / std::sqrt(options.rate);
  ImuBias bias{first, options.initial_accelerometer_bias, options.initial_gyroscope_bias};
  ImuRecording recording;
  for (std::int64_t i = 0;; ++i) {
    bias.stamp = instantOf(i, first, options, &jitter);
    if (bias.stamp > last) return recording;
    ImuSample sample = ideal.at(bias.stamp);
    sample.stamp = bias.stamp;
    const Vector3d noise = options.noise.accelerometer_noise * white_scale * white.normal3();
    sample.acceleration =
        (own ? own->at(bias.stamp) : Vector3d(sample.acceleration + noise)) + bias.accelerometer;
    sample.angular_velocity +=
        bias.gyroscope + options.noise.gyroscope_noise * white_scale * white.normal3();
    recording.samples.push_back(sample);
    recording.biases.push_back(bias);
    bias.accelerometer += options.noise.accelerometer_walk * walk_scale * walk.normal3();
    bias.gyroscope += options.noise.gyroscope_walk * walk_scale * walk.normal3();
  }
}

}  // namespace vins::simulation
