#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/relative_pose.h"

namespace vins::estimator {

/// A turn between two frames that gyroscope and camera have both seen, as rotation vectors:
/// phi_b + (td - td_used) (w_end - w_begin) - b duration = R_bc phi_c.
struct TurnPair {
  Eigen::Vector3d body = Eigen::Vector3d::Zero();         ///< integrated gyroscope, phi_b [rad]
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();       ///< phi_c [rad]
  Eigen::Vector3d rate_change = Eigen::Vector3d::Zero();  ///< w_end - w_begin, gyroscope [rad/s]
  double duration = 0.0;                                  ///< [s]
  double td_used = 0.0;                                   ///< the frames were timed with [s]
};

/// What turns tell of the rig: how the camera is turned in the body frame, the time offset, and the
/// gyroscope's bias.
struct TurnCalibration {
  Eigen::Quaterniond R_bc = Eigen::Quaterniond::Identity();
  double td = 0.0;                                           ///< t_imu = t_cam + td [s]
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();  ///< [rad/s]
  double rotation_sigma = 0.0;  ///< of R_bc, about the axis that is known least [rad]
  double td_sigma = 0.0;        ///< [s]
  int pairs = 0;                ///< turns that agree
};

/// Deviations of what is known before.
struct TurnPrior {
  double rotation_sigma = 1e-6;  ///< of R_bc [rad]; not positive: nothing is known
  double td_sigma = 1e-6;        ///< [s]
  double bias_sigma = 0.05;      ///< of the gyroscope about zero [rad/s]
};

/// The rotation that takes the camera's turns to the body's, from nothing: least squares over
/// rotation vectors (G. Wahba's problem, by singular values: K. Arun, T. Huang, S. Blostein, PAMI
/// 1987). Nothing for fewer than two turns.
std::optional<Eigen::Quaterniond> fitHandEyeRotation(const std::vector<TurnPair>& pairs);

/// R_bc, td and the gyroscope's bias together, from the guess on, with robust weights. `sigma`:
/// deviation of a turn, per axis [rad]. Nothing for fewer than two turns, or where they tell too
/// little to solve.
std::optional<TurnCalibration> calibrateByTurns(const std::vector<TurnPair>& pairs,
                                                const TurnCalibration& guess,
                                                const TurnPrior& prior, double sigma);

/// Options of TurnCalibrator.
struct TurnCalibratorOptions {
  TurnPrior prior;
  double min_turn = 0.08;        ///< between two frames that are compared [rad]
  int min_shared = 30;           ///< features that they share
  int min_pairs = 8;             ///< turns that agree
  int max_pairs = 200;           ///< kept; the oldest go
  double max_sigma = 0.015;      ///< of an unknown R_bc that is good enough [rad]
  double turn_sigma = 3e-3;      ///< of a camera's turn, per axis [rad]
  double pixel_noise = 1.0;      ///< deviation of a corner [px]
  double report_interval = 1.0;  ///< between events that tell why it waits [s]
};

/// Finds how the camera is turned against the IMU, and how their clocks differ, by watching both
/// turn ("hand-eye"; Z. Yang, S. Shen, "Monocular visual-inertial state estimation with online
/// initialization and camera-IMU extrinsic calibration", T-ASE 2017): before anything else is
/// known. Where R_bc is unknown it needs turns about two axes, and tells by the event
/// `extrinsic_waiting` how much is missing.
class TurnCalibrator {
 public:
  /// `guess`: R_bc and td as configured.
  TurnCalibrator(const TurnCalibratorOptions& options, const TurnCalibration& guess)
      : options_(options), guess_(guess) {}

  /// Takes the next frame, timed with `td` [s]. What is known by now, if it is enough.
  std::optional<TurnCalibration> addFrame(const FrameMeasurements& measurements, double td);

  std::vector<Event> takeEvents();
  void clear();

 private:
  void integrate(const std::vector<ImuSample>& samples);
  void compare(const FrameMeasurements& measurements, const std::vector<BearingPair>& shared,
               double td);
  void restartAt(const FrameMeasurements& measurements);
  std::optional<TurnCalibration> fit() const;
  void report(Stamp stamp, const std::optional<TurnCalibration>& found);

  TurnCalibratorOptions options_;
  TurnCalibration guess_;
  std::optional<FeatureFrame> reference_;
  Eigen::Vector3d reference_rate_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn_b_ = Eigen::Quaterniond::Identity();  ///< since the reference
  double duration_ = 0.0;                                       ///< since the reference [s]
  std::deque<TurnPair> pairs_;
  std::optional<Stamp> last_report_;
  std::vector<Event> events_;
};

}  // namespace vins::estimator
