#pragma once

#include <vector>

#include "estimator_test_values.h"
#include "vins_estimator/window/sliding_window.h"
#include "vins_estimator/window/window_start.h"

namespace vins::estimator::testing {

/// A window whose states, landmarks and measurements agree exactly: waving motion, points ahead of
/// the camera, each seen in every frame from `begin` to `end`.
struct SyntheticWindow {
  SlidingWindow window;
  std::vector<NavState> truth;
};

inline FeatureObservation observe(std::int64_t id, const Pose& T_wc, const Eigen::Vector3d& p_w,
                                  double noise, Random* random) {
  FeatureObservation observation;
  observation.id = id;
  observation.angular_resolution = 1.0 / 460.0;
  const Eigen::Vector3d bearing = (T_wc.inverse() * p_w).normalized();
  // Deviation per axis of the tangent plane.
  const Eigen::Vector3d shift = noise / 460.0 * random->normal3();
  observation.bearing = (bearing + shift).normalized();
  return observation;
}

/// Range of frames in which a landmark is seen.
struct Visibility {
  int begin = 0;
  int end = 1000;
};

/// `visibility(k)` of landmark k; pixel noise [px].
template <typename VisibilityOf>
SyntheticWindow makeWindow(int frames, int landmarks, double noise, VisibilityOf visibility) {
  Random random(7);
  const ImuNoise imu_noise{2.0e-3, 1.7e-4, 3.0e-3, 1.9e-5, 9.81};
  SyntheticWindow result;
  SlidingWindow& window = result.window;
  window.rig.T_bc =
      Pose(so3::exp(Eigen::Vector3d(0.1, -0.2, 0.05)), Eigen::Vector3d(0.05, 0.02, 0.1));

  NavState state;
  state.T_wb = Pose(so3::exp(Eigen::Vector3d(0.1, -0.05, 0.4)), Eigen::Vector3d(1.0, 2.0, 3.0));
  state.v_w = {0.6, -0.4, 0.1};
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < landmarks; ++k) {
    points.push_back(state.T_wb * window.rig.T_bc *
                     Eigen::Vector3d(1.5 * random.normal(), 1.5 * random.normal(),
                                     4.0 + 2.0 * random.uniform()));
  }
  const auto samples = wavingSamples(0.2 * frames, 200.0);
  Initialization start;
  for (int i = 0; i < frames; ++i) {
    Preintegration imu(imu_noise, state.accelerometer_bias, state.gyroscope_bias);
    if (i > 0) {
      imu.integrate({samples.begin() + 40 * (i - 1), samples.begin() + 40 * i + 1});
      state = imu.predict(state, window.g_w);
    }
    FeatureFrame features;
    features.stamp = 200'000'000 * i;
    for (int k = 0; k < landmarks; ++k) {
      const Visibility seen = visibility(k);
      if (i < seen.begin || i >= seen.end) continue;
      features.observations.push_back(observe(k, state.T_wb * window.rig.T_bc,
                                              points[static_cast<std::size_t>(k)], noise, &random));
    }
    start.frames.push_back(
        {features, state, imu, samples[static_cast<std::size_t>(40 * i)].angular_velocity});
    result.truth.push_back(state);
  }
  start.mean = result.truth.front();
  start.sigma << 1e-3, 1e-3, 1e-3, 0.05, 0.05, 1e-3, 1, 1, 1, 0.2, 0.2, 0.2, 0.05, 0.05, 0.05;
  startWindow(start, 0, &window);
  triangulateTracks(&window);
  return result;
}

}  // namespace vins::estimator::testing
