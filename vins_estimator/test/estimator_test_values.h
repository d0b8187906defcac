#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "vins_core/imu.h"
#include "vins_core/so3.h"
#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator::testing {

/// Normal numbers, the same on every platform that has IEEE arithmetic.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  double uniform() { return (static_cast<double>(generator_() >> 11) + 0.5) * 0x1.0p-53; }
  double normal() {
    return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * M_PI * uniform());
  }
  Eigen::Vector3d normal3() {
    Eigen::Vector3d v;
    for (double& x : v) x = normal();
    return v;
  }
  Pose pose(double position_scale = 1.0) {
    const Eigen::Quaterniond q(normal(), normal(), normal(), normal());
    return {q.normalized(), position_scale * normal3()};
  }
  NavState navState() {
    NavState state;
    state.T_wb = pose();
    state.v_w = normal3();
    state.accelerometer_bias = 0.1 * normal3();
    state.gyroscope_bias = 0.02 * normal3();
    return state;
  }

 private:
  std::mt19937_64 generator_;
};

/// Readings of a lively motion: sinusoids about gravity, at `rate` [Hz] from 0 to `duration` [s].
inline std::vector<ImuSample> wavingSamples(double duration, double rate) {
  std::vector<ImuSample> samples;
  const int count = static_cast<int>(std::lround(duration * rate));
  for (int k = 0; k <= count; ++k) {
    const double t = k / rate;
    ImuSample sample;
    sample.stamp = toNanoseconds(t);
    sample.acceleration = {1.5 * std::sin(5.0 * t), 2.0 * std::cos(3.0 * t),
                           9.81 + std::sin(7.0 * t)};
    sample.angular_velocity = {0.8 * std::cos(4.0 * t), 0.6 * std::sin(6.0 * t),
                               -0.9 * std::cos(2.0 * t)};
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace vins::estimator::testing
