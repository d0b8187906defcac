#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/keyframe.h"
#include "vins_core/loop_match.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"
#include "vins_estimator/estimator_options.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/rig_calibration.h"
#include "vins_estimator/window/window_output.h"

namespace vins::estimator {

/// What the estimator is doing.
enum class EstimatorStatus { kInitializing, kTracking };

const char* toString(EstimatorStatus status);

/// The newest frame's state, as known when it came.
struct Odometry {
  Stamp stamp = 0;                                               ///< the image's [ns]
  NavState state;                                                ///< in the odometry's world
  Eigen::Vector3d angular_velocity_b = Eigen::Vector3d::Zero();  ///< free of bias [rad/s]
  double angular_velocity_variance = 0.0;    ///< of the white noise in it, per axis [rad^2/s^2]
  Matrix15d covariance = Matrix15d::Zero();  ///< of `state`, by ErrorState
  std::uint32_t sequence = 0;                ///< rises when the estimator resets
};

/// What one frame's work was.
struct EstimatorStatistics {
  int features = 0;         ///< tracks in the newest frame
  int landmarks = 0;        ///< in the window's adjustment
  int observations = 0;     ///< of these landmarks
  int outliers = 0;         ///< observations rejected after the solution
  int iterations = 0;       ///< of the solver
  double cost_initial = 0;  ///< half the sum of squares
  double cost_final = 0;
  bool keyframe = false;             ///< the window slid by its oldest frame
  bool motion_only = false;          ///< only the newest frames were adjusted
  double solve_seconds = 0.0;        ///< for people and diagnostics only: nothing depends on it
  double marginalize_seconds = 0.0;  ///< as above
};

/// What came of one frame.
struct EstimatorResult {
  Stamp stamp = 0;  ///< the frame's
  EstimatorStatus status = EstimatorStatus::kInitializing;
  std::optional<Odometry> odometry;  ///< nothing while initializing
  /// Relative deviation of the scale while that converges after a moving start; nullopt otherwise.
  std::optional<double> scale_sigma;
  std::vector<Event> events;
  std::vector<Keyframe> keyframes;       ///< have just become such
  std::vector<KeyframePoseUpdate> left;  ///< keyframes that left the window, with their last pose
  std::vector<LoopEdge> loop_edges;      ///< refined loops
  std::vector<LandmarkPoint> landmarks;  ///< in the newest window
  std::vector<StampedNavState> window;   ///< the frames of the window, oldest first
  RigCalibration rig;                    ///< as configured, or as estimated
  RigMatrix rig_covariance = RigMatrix::Zero();  ///< of its errors; zero: not estimated
  EstimatorStatistics statistics;
};

/// Visual-inertial odometry: IMU samples and feature frames in, the state with covariance out.
/// Needs no thread or file, and looks at a clock for its statistics only; the same input gives the
/// same bits unless max_solver_time strikes. (T. Qin, P. Li, S. Shen,
/// "VINS-Mono", T-RO 2018; first-estimates Jacobians and square-root marginalization differ.)
class Estimator {
 public:
  /// Throws InputError for options that are out of range.
  explicit Estimator(const EstimatorOptions& options);
  ~Estimator();
  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;

  /// Samples and frames in the order of arrival; what is out of order, double or not finite is
  /// dropped, counted and told by an event of the next result.
  void addImu(const ImuSample& sample);
  void addFrame(FeatureFrame frame);
  /// Tells the stamp of an image whose frame waits outside for its IMU samples, so that clocks that
  /// are apart are found although no frame ever comes [ns].
  void addImageStamp(Stamp stamp);
  /// A verified loop, for the window's adjustments from 0.15 s after its query keyframe on.
  void addLoopMatch(const LoopMatch& match);

  /// Tells that frames wait outside: with motion_only_ba 2 the window's adjustment is put off while
  /// there are several. Never called, nothing depends on time.
  void setBacklog(int frames);

  /// Works on the oldest frame whose IMU samples have all come; nothing where there is none. Call
  /// until it returns nothing.
  std::optional<EstimatorResult> process();

  /// Findings about the inputs (ImuPlausibility) since the last call. They are no part of a frame's
  /// result, for bad inputs may be why there is none. Call after process().
  std::vector<Event> takeInputEvents();

  /// Forgets everything but the options and the sequence's number, which rises.
  void reset();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vins::estimator
