#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/pose.h"
#include "vins_core/so3.h"
#include "vins_estimator/inertial/measurement_queue.h"

namespace vins::estimator::testing {

/// Where the body is at a time [s].
using Motion = std::function<Pose(double t)>;

/// Landmarks, camera and IMU around a motion, for tests of the initialization. (The simulator of
/// package vins_tests is out of reach from here.)
struct SyntheticFlight {
  Motion motion;
  std::vector<Eigen::Vector3d> landmarks_w;
  Pose T_bc;
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();
  double pixel_noise = 0.0;    ///< [px], 460 of them to a radian
  double outlier_share = 0.0;  ///< of tracks, which see a point of their own in each frame
  double gravity = 9.81;
  std::uint64_t seed = 1;

  /// By central differences over 2 h, exact to about 1e-7.
  ImuSample imuAt(double t) const {
    constexpr double h = 1e-3;
    const Pose before = motion(t - h), now = motion(t), after = motion(t + h);
    const Eigen::Vector3d acceleration =
        ((after.position - now.position) - (now.position - before.position)) / (h * h);
    ImuSample sample;
    sample.stamp = toNanoseconds(t);
    sample.acceleration =
        now.rotation.conjugate() * (acceleration + gravity * Eigen::Vector3d::UnitZ()) +
        accelerometer_bias;
    sample.angular_velocity =
        so3::log(before.rotation.conjugate() * after.rotation) / (2.0 * h) + gyroscope_bias;
    return sample;
  }

  Eigen::Vector3d velocity(double t) const {
    constexpr double h = 1e-4;
    return (motion(t + h).position - motion(t - h).position) / (2.0 * h);
  }

  /// What the camera sees within 45 degrees of its axis.
  FeatureFrame frameAt(double t) const {
    std::mt19937_64 engine(seed * 1000003u + static_cast<std::uint64_t>(toNanoseconds(t)));
    const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1.0p-53; };
    const auto noise = [&] {  // nearly normal, of deviation one
      double sum = -6.0;
      for (int i = 0; i < 12; ++i) sum += uniform();
      return sum;
    };
    const Pose T_cw = (motion(t) * T_bc).inverse();
    FeatureFrame frame;
    frame.stamp = toNanoseconds(t);
    for (std::size_t i = 0; i < landmarks_w.size(); ++i) {
      const Eigen::Vector3d in_camera = T_cw * landmarks_w[i];
      if (in_camera.z() < 0.2 || in_camera.head<2>().norm() > in_camera.z()) continue;
      const bool outlier = static_cast<double>(i) < outlier_share * landmarks_w.size();
      const double deviation = (outlier ? 40.0 : pixel_noise) / 460.0;
      FeatureObservation observation;
      observation.id = static_cast<std::int64_t>((i * 7919) % landmarks_w.size());
      const Eigen::Vector3d error(noise(), noise(), noise());
      observation.bearing = (in_camera.normalized() + deviation * error).normalized();
      observation.angular_resolution = 1.0 / 460.0;
      frame.observations.push_back(observation);
    }
    return frame;
  }

  /// From `begin` on, 200 Hz between the frames at 20 Hz.
  std::vector<FrameMeasurements> record(double begin, double duration) const {
    std::vector<FrameMeasurements> result;
    const int frames = static_cast<int>(std::lround(duration * 20.0)) + 1;
    for (int k = 0; k < frames; ++k) {
      FrameMeasurements measurements;
      measurements.frame = frameAt(begin + 0.05 * k);
      measurements.is_first = k == 0;
      for (int i = k == 0 ? 0 : -10; i <= 0; ++i) {
        measurements.imu.push_back(imuAt(begin + 0.05 * k + 0.005 * i));
      }
      measurements.begin = measurements.imu.front().stamp;
      measurements.end = measurements.imu.back().stamp;
      measurements.longest_gap = 0.005;
      result.push_back(measurements);
    }
    return result;
  }
};

/// Points in a box.
inline std::vector<Eigen::Vector3d> pointsInBox(int count, const Eigen::Vector3d& lower,
                                                const Eigen::Vector3d& upper,
                                                std::uint64_t seed = 1) {
  std::mt19937_64 engine(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d share;
    for (int k = 0; k < 3; ++k) share(k) = static_cast<double>(engine() >> 11) * 0x1.0p-53;
    points.emplace_back(lower + share.cwiseProduct(upper - lower));
  }
  return points;
}

/// A lively flight about the origin: camera (= body) axis z looks along world x, centimetres to
/// decimetres of acceleration-rich sway while going sideways.
inline Pose livelyMotion(double t) {
  Eigen::Matrix3d R_forward;  // body x right (-y), y down (-z), z ahead (x)
  R_forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Vector3d turn(0.1 * std::sin(1.3 * t), 0.15 * std::sin(0.9 * t + 1.0),
                             0.1 * std::cos(1.1 * t));
  const Eigen::Vector3d p(0.3 * std::sin(1.7 * t), 0.6 * t + 0.3 * std::sin(2.3 * t),
                          0.25 * std::cos(1.9 * t));
  return {(Eigen::Quaterniond(R_forward) * so3::exp(turn)).normalized(), p};
}

/// livelyMotion() before a wall of boxes.
inline SyntheticFlight livelyFlight() {
  SyntheticFlight flight;
  flight.motion = livelyMotion;
  flight.landmarks_w = pointsInBox(250, {4.0, -5.0, -4.0}, {9.0, 8.0, 4.0});
  flight.T_bc = Pose(so3::exp(Eigen::Vector3d(0.05, -0.08, 0.1)), {0.05, -0.03, 0.08});
  return flight;
}

/// The same flight in a world turned about the vertical and shifted.
inline SyntheticFlight movedWorld(SyntheticFlight flight, double yaw,
                                  const Eigen::Vector3d& shift) {
  const Pose T_nw(so3::exp(yaw * Eigen::Vector3d::UnitZ()), shift);
  const Motion motion = flight.motion;
  flight.motion = [T_nw, motion](double t) { return T_nw * motion(t); };
  for (Eigen::Vector3d& point : flight.landmarks_w) point = T_nw * point;
  return flight;
}

}  // namespace vins::estimator::testing
