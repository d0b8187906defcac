#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/pose.h"
#include "vins_estimator/health/stillness.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"
#include "vins_estimator/initialization/initialization.h"
#include "vins_estimator/initialization/retiming.h"
#include "vins_estimator/initialization/static_initializer.h"
#include "vins_estimator/initialization/visual_inertial_alignment.h"
#include "vins_estimator/initialization/visual_structure.h"
#include "vins_estimator/initialization/waiting_reason.h"

namespace vins::estimator {

/// Options of Initializer.
struct InitializerOptions {
  ImuNoise imu;
  Pose T_bc;                     ///< camera in the body frame
  double pixel_noise = 1.0;      ///< deviation of a tracked corner, per axis [px]
  int max_frames = 11;           ///< that an Initialization has, at least 5
  double max_span = 5.0;         ///< of the frames chosen for a moving start [s]
  double min_span = 0.8;         ///< the same [s]
  int attempt_interval = 4;      ///< frames between attempts at a moving start
  double report_interval = 1.0;  ///< between events that tell why it waits [s]
  double max_gap = 0.05;         ///< between IMU samples; after a longer one it begins anew [s]
  std::uint64_t seed = 1;        ///< of the random samples
  StillnessOptions stillness;    ///< its gravity is imu.gravity, whatever it says
  StaticInitializerOptions at_rest;
  VisualStructureOptions structure;
  AlignmentOptions alignment;

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// Finds the first states: at rest (gravity's direction and the gyroscope's bias from a still
/// interval), or moving (structure from motion aligned with the IMU; T. Qin, S. Shen, "Robust
/// initialization of monocular visual-inertial estimation on aerial robots", IROS 2017, with a
/// joint refinement and a test of its information on top). Until one of them succeeds it tells by
/// events why it waits: `init_few_tracks`, `init_little_parallax`, `init_little_excitation`,
/// `init_inconsistent`. An attempt that fails leaves nothing behind but the measurements.
class Initializer {
 public:
  /// Throws InputError for options that are out of range.
  explicit Initializer(const InitializerOptions& options);

  /// Takes the next frame; the first states if they are found now, the newest frame's the last of
  /// them. Frames that do not follow the ones before (first of a recording, hole in the IMU) begin
  /// anew. After a start at rest it has forgotten all measurements; those of a moving start stay.
  /// `may_move`: false where only a start at rest is wanted.
  std::optional<Initialization> addFrame(const SharedMeasurements& measurements,
                                         bool may_move = true);

  /// After a moving start: takes the next frame without looking for a start.
  void remember(const SharedMeasurements& measurements);

  /// Solves the moving start again with all frames that are remembered, the newest one included.
  std::optional<Initialization> solveAgain();

  /// Times the remembered frames and `newest`, which follows them, anew for a time offset larger by
  /// `shift` [s], and remembers them so. The next frame is expected to follow the last of them.
  RetimedFrames retime(const SharedMeasurements& newest, double shift);

  /// What there is to tell since the last call.
  std::vector<Event> takeEvents();

  /// Where the camera stands in the body frame, from now on.
  void setExtrinsic(const Pose& T_bc) { options_.T_bc = T_bc; }

  /// Forgets all measurements; random samples begin anew.
  void clear();

 private:
  using FrameIndices = std::vector<std::size_t>;

  std::optional<Initialization> startAtRest() const;
  std::optional<Initialization> startMoving();
  std::optional<Initialization> alignFrames(const FrameIndices& chosen,
                                            const VisualStructure& structure,
                                            const std::vector<Preintegration>& imu,
                                            const InputFigures& inputs);
  std::vector<FrameIndices> chooseFrames() const;
  FrameIndices spreadOver(double span) const;
  bool isConnected(const FrameIndices& chosen) const;
  int sharedFeatures(std::size_t a, std::size_t b) const;
  std::vector<Preintegration> integrateBetween(const FrameIndices& chosen) const;
  std::vector<StructureFrame> structureFrames(const FrameIndices& chosen,
                                              const std::vector<Preintegration>& imu) const;
  Initialization toInitialization(const FrameIndices& chosen, const Alignment& alignment) const;
  void push(const SharedMeasurements& measurements);
  void forgetOld();
  void report(Stamp stamp);
  double bufferedSpan() const;

  InitializerOptions options_;
  StillnessDetector stillness_;
  std::deque<SharedMeasurements> buffer_;
  int frames_until_attempt_;
  WaitingReason reason_;  ///< of the last attempt that failed, until it is told
  std::optional<Stamp> last_report_;
  std::vector<Event> events_;
  std::mt19937_64 engine_;
};

}  // namespace vins::estimator
