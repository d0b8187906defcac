#include "vins_estimator/initialization/static_initializer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include "vins_core/option_check.h"
#include "vins_core/time.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

/// What the samples of a still interval say.
struct RestMeasurement {
  Vector3d specific_force = Vector3d::Zero();
  Vector3d gyroscope_bias = Vector3d::Zero();
  double rate_sigma = 0.0;  ///< of the mean rate, by the scatter between frames [rad/s]
  int samples = 0;
};

Vector3d meanRate(const std::vector<ImuSample>& samples) {
  Vector3d sum = Vector3d::Zero();
  for (const ImuSample& sample : samples) sum += sample.angular_velocity;
  return sum / static_cast<double>(samples.size());
}

RestMeasurement measure(const std::vector<const FrameMeasurements*>& interval) {
  RestMeasurement rest;
  Vector3d force = Vector3d::Zero(), rate = Vector3d::Zero(), squares = Vector3d::Zero();
  int intervals = 0;
  for (std::size_t i = 1; i < interval.size(); ++i) {
    if (interval[i]->imu.empty()) continue;
    for (const ImuSample& sample : interval[i]->imu) {
      force += sample.acceleration;
      ++rest.samples;
    }
    const Vector3d mean = meanRate(interval[i]->imu);
    rate += mean;
    squares += mean.cwiseAbs2();
    ++intervals;
  }
  if (rest.samples == 0) return rest;
  rest.specific_force = force / rest.samples;
  rest.gyroscope_bias = rate / intervals;
  const Vector3d variance = squares / intervals - rest.gyroscope_bias.cwiseAbs2();
  rest.rate_sigma = std::sqrt(std::max(0.0, variance.maxCoeff()) / intervals);
  return rest;
}

/// Indices of `count` frames out of `size`, evenly spread, the first and the last among them.
std::vector<std::size_t> spread(std::size_t size, std::size_t count) {
  count = std::min(size, count);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(i * (size - 1) / (count - 1));
  return chosen;
}

Vector15d sigmaAtRest(const RestMeasurement& rest, const StaticInitializerOptions& options) {
  Vector15d sigma;
  sigma.segment<3>(kPosition).setConstant(options.position_sigma);
  sigma.segment<3>(kRotation) << options.tilt_sigma, options.tilt_sigma, options.yaw_sigma;
  sigma.segment<3>(kVelocity).setConstant(options.velocity_sigma);
  sigma.segment<3>(kAccBias).setConstant(options.accelerometer_bias_sigma);
  sigma.segment<3>(kGyrBias).setConstant(
      std::hypot(options.min_gyroscope_bias_sigma, rest.rate_sigma));
  return sigma;
}

}  // namespace

void StaticInitializerOptions::validate() const {
  if (frames < 2) {
    refuseOption("start at rest", "frames", frames, "at least 2");
  }
  requirePositive("start at rest", "position_sigma", position_sigma);
  requirePositive("start at rest", "tilt_sigma", tilt_sigma);
  requirePositive("start at rest", "yaw_sigma", yaw_sigma);
  requirePositive("start at rest", "velocity_sigma", velocity_sigma);
  requirePositive("start at rest", "accelerometer_bias_sigma", accelerometer_bias_sigma);
  requirePositive("start at rest", "min_gyroscope_bias_sigma", min_gyroscope_bias_sigma);
}

Eigen::Quaterniond levelRotation(const Vector3d& up_b) {
  return Eigen::Quaterniond::FromTwoVectors(up_b, Vector3d::UnitZ());
}

Eigen::Quaterniond withoutYaw(const Eigen::Quaterniond& R_wb) {
  return levelRotation(R_wb.conjugate() * Vector3d::UnitZ());
}

std::optional<Initialization> initializeAtRest(
    const std::vector<const FrameMeasurements*>& interval, const ImuNoise& noise,
    const StaticInitializerOptions& options) {
  if (interval.size() < 2) return std::nullopt;
  const RestMeasurement rest = measure(interval);
  if (rest.samples == 0 || !(rest.specific_force.norm() > 0.0)) return std::nullopt;

  NavState state;
  state.T_wb.rotation = levelRotation(rest.specific_force.normalized());
  state.gyroscope_bias = rest.gyroscope_bias;
  Initialization initialization;
  initialization.at_rest = true;
  initialization.mean = state;
  initialization.sigma = sigmaAtRest(rest, options);
  const auto chosen = spread(interval.size(), static_cast<std::size_t>(options.frames));
  std::size_t next = 1;
  for (const std::size_t index : chosen) {
    Preintegration imu(noise, state.accelerometer_bias, state.gyroscope_bias);
    for (; next <= index; ++next) imu.integrate(interval[next]->imu);
    initialization.frames.push_back({interval[index]->frame, state, imu, Eigen::Vector3d::Zero(),
                                     Eigen::Vector3d::Zero(), interval[index]->undone_readout});
  }
  return initialization;
}

}  // namespace vins::estimator
