#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/faults.h"
#include "simulation/feature_simulator.h"
#include "simulation/odometry_figures.h"
#include "vins_estimator/estimator_options.h"

namespace vins::simulation {

/// A flight to simulate at the level of features, and the estimator that is to follow it.
struct OdometryStudyOptions {
  OdometryStudyOptions();

  std::string trajectory = "hall_loop";   ///< built-in name, or a file of poses
  std::string imu_noise = "euroc";        ///< euroc, low (a tenth of it) or none
  double imu_rate = 200.0;                ///< [Hz]
  double vibration = 0.0;                 ///< at 90 Hz, root mean square [m/s^2]
  double time_offset = 0.0;               ///< the true td [s]
  Pose T_bc;                              ///< the true one; EuRoC's
  FeatureSimulatorOptions features;       ///< start and duration are the flight's; the seed is not
  std::vector<TimeInterval> blackouts;    ///< frames without features, from the flight's start on
  ImuFaults imu_faults;                   ///< from the flight's start on
  bool propagates = false;                ///< odometry at the IMU's rate too
  std::size_t keep_every = 1;             ///< of so many odometry samples one is kept
  estimator::EstimatorOptions estimator;  ///< T_bc and td as the estimator is told; EuRoC's and 0.
                                          ///< IMU and pixel noise are those simulated

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// Simulates a flight with EuRoC's left camera and lets an estimator follow it. Everything random
/// follows from the seed. Throws InputError for bad options.
OdometryRun runOdometry(const OdometryStudyOptions& options, std::uint64_t seed);

}  // namespace vins::simulation
