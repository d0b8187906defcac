#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vins_core/event.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"
#include "vins_estimator/estimator.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/propagator.h"

namespace vins::simulation {

/// The pose that holds the world: the oldest of the first window.
struct Gauge {
  Pose estimate;
  Pose truth;
};

/// The state and what it should have been.
struct OdometrySample {
  estimator::Odometry estimate;
  estimator::NavState truth;
  std::optional<Gauge> gauge;                                         ///< with the first sample
  Eigen::Vector3d true_angular_velocity_b = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// The same of a state that the IMU has carried on from the last odometry.
struct PropagatedSample {
  estimator::PropagatedState estimate;
  estimator::NavState truth;
  Eigen::Vector3d true_angular_velocity_b = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// What the estimator made of a flight.
struct OdometryRun {
  std::uint64_t seed = 0;
  Stamp begin = 0;  ///< of the first frame [ns]
  std::size_t frames = 0;
  std::vector<OdometrySample> samples;       ///< one for each odometry, or fewer as asked for
  std::vector<PropagatedSample> propagated;  ///< one for each IMU sample, where asked for
  std::vector<double> frame_seconds;         ///< work of the estimator on each frame [s]
  std::vector<double> megabytes;             ///< resident memory after each minute of the flight
  std::vector<Event> events;
  estimator::RigCalibration rig;       ///< as last estimated
  estimator::RigCalibration true_rig;  ///< as simulated
  estimator::RigMatrix rig_covariance =
      estimator::RigMatrix::Zero();  ///< zero where the rig was not estimated
};

/// Normalised estimation error squared (NEES), averaged over a run, per degree of freedom: 1 is
/// what the covariance promises. (Y. Bar-Shalom et al., "Estimation with applications to tracking
/// and navigation", 2001, section 5.4.)
struct Consistency {
  double position = 0.0;
  double rotation = 0.0;
  double pose = 0.0;  ///< both, with their correlation
  double velocity = 0.0;
  double accelerometer_bias = 0.0;
  double gyroscope_bias = 0.0;
};

/// A run in figures.
struct OdometryFigures {
  std::uint64_t seed = 0;
  bool initialised = false;
  double completeness = 0.0;                ///< share of the frames that have an odometry
  double resets = 0.0;                      ///< sequences beyond the first
  double time_to_initialise = 0.0;          ///< from the first frame to the first odometry [s]
  std::optional<double> early_scale_error;  ///< over the first 2 s of odometry; nothing: at rest
  double scale_error = 0.0;                 ///< over all; 0.01: the estimate is 1 % too large
  double distance = 0.0;                    ///< truly flown since the first odometry [m]
  double ate = 0.0;                         ///< position RMSE after posyaw alignment [m]
  double rotation_error = 0.0;              ///< RMSE after posyaw alignment [rad]
  double drift = 0.0;  ///< last position's error, with the gauge laid on the truth [m]
  Consistency nees;
  double td_error = 0.0;                     ///< by its size, at the end [s]
  double extrinsic_rotation_error = 0.0;     ///< at the end [rad]
  double extrinsic_translation_error = 0.0;  ///< at the end [m]
  double nees_rig = 0.0;   ///< of what was estimated of the rig, at the end, per degree of freedom
  double uncovered = 0.0;  ///< share of samples whose covariance is not positive definite
  double mean_ms = 0.0;    ///< of the estimator per frame [ms]
  double p95_ms = 0.0;     ///< [ms]

  double ateShare() const { return distance > 0.0 ? ate / distance : 0.0; }  ///< of the distance
};

/// The transform that takes estimated positions to true ones with the least squares: translation
/// and rotation about z (S. Umeyama, PAMI 1991, restricted to yaw). As many of one as of the other;
/// no turn where the positions tell none.
Pose alignPositionAndYaw(const std::vector<Eigen::Vector3d>& estimated,
                         const std::vector<Eigen::Vector3d>& truth);

/// The transform, likewise, that lays the position and the yaw of one pose onto the true one.
Pose alignPositionAndYaw(const Pose& estimated, const Pose& truth);

/// By how much the estimate is too large: 0.01 is 1 %, from the similarity that takes estimated to
/// true positions (Umeyama, as above). Nothing where the true positions spread by less than 5 cm.
std::optional<double> scaleError(const std::vector<Eigen::Vector3d>& estimated,
                                 const std::vector<Eigen::Vector3d>& truth);

/// For the NEES, the gauge pose is laid onto the truth by position and yaw; for the ATE, all
/// positions are.
OdometryFigures evaluate(const OdometryRun& run);

/// Means over the runs that were initialised; `completeness` and `resets`: over all.
struct OdometryAverages {
  std::size_t runs = 0;
  std::size_t initialised = 0;
  OdometryFigures mean;
  double worst_ate = 0.0;          ///< [m]
  double worst_scale_error = 0.0;  ///< by its size
};
OdometryAverages average(const std::vector<OdometryFigures>& figures);

/// A table: a line for each run, and the means.
void printTable(std::ostream& out, const std::vector<OdometryFigures>& figures);

/// {"runs": [{...}, ...], "mean": {...}}, in SI units.
std::string toJson(const std::vector<OdometryFigures>& figures);

}  // namespace vins::simulation
