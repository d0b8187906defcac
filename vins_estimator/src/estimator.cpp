#include "vins_estimator/estimator.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "part_options.h"
#include "vins_estimator/health/continuation.h"
#include "vins_estimator/health/failure_detector.h"
#include "vins_estimator/health/imu_plausibility.h"
#include "vins_estimator/health/rig_check.h"
#include "vins_estimator/health/stillness.h"
#include "vins_estimator/health/track_watch.h"
#include "vins_estimator/inertial/body_twist.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/extrinsic_rotation.h"
#include "vins_estimator/initialization/initializer.h"
#include "vins_estimator/initialization/scale_convergence.h"
#include "vins_estimator/initialization/time_offset_initializer.h"
#include "vins_estimator/visual/rolling_shutter.h"
#include "vins_estimator/window/rig_score.h"
#include "window_tracker.h"

namespace vins::estimator {
namespace {

/// From a keyframe's image to the use of its loop: three images at 20 Hz, in which a place is
/// recognised on any machine that keeps up [s].
constexpr double kLoopDelay = 0.15;

void moveEvents(std::vector<Event> events, EstimatorResult* result) {
  for (Event& event : events) result->events.push_back(std::move(event));
}

}  // namespace

const char* toString(EstimatorStatus status) {
  return status == EstimatorStatus::kTracking ? "tracking" : "initializing";
}

class Estimator::Implementation {
 public:
  explicit Implementation(const EstimatorOptions& options)
      : options_(options),
        queue_(queueOptions()),
        calibrator_(calibratorOptions(options), {options.T_bc.rotation, options.td}),
        time_offset_(options.estimate_td),
        initializer_(initializerOptions(options)),
        stillness_(initializerOptions(options).stillness),
        plausibility_(plausibilityOptions(options)),
        track_watch_(options.min_tracks),
        rig_check_(rigCheckOptions(options)),
        continuation_(options.imu),
        tracker_(options) {
    reset();
  }

  void addImu(const ImuSample& sample) {
    plausibility_.addImu(sample);
    queue_.addImu(sample);
  }
  void addFrame(FeatureFrame frame) {
    plausibility_.addImage(frame.stamp);
    queue_.addFrame(std::move(frame));
  }
  void addImageStamp(Stamp stamp) { plausibility_.addImage(stamp); }
  std::vector<Event> takeInputEvents() { return plausibility_.takeEvents(); }
  void setBacklog(int frames) { backlog_ = frames; }
  void addLoopMatch(const LoopMatch& match) {
    if (status_ == EstimatorStatus::kTracking) waiting_loops_.push_back(match);
  }

  std::optional<EstimatorResult> process() {
    std::optional<FrameMeasurements> measurements =
        queue_.next(tracker_.window().rig.td, readout());
    if (!measurements) return std::nullopt;
    EstimatorResult result;
    result.stamp = measurements->frame.stamp;
    moveEvents(queue_.takeEvents(), &result);
    if (measurements->restarted) reset();
    if (status_ == EstimatorStatus::kTracking) checkInterval(*measurements, &result);
    if (readout() > 0.0) undoRollingShutter(&*measurements);
    const auto shared = std::make_shared<const FrameMeasurements>(*std::move(measurements));
    stillness_.addFrame(shared);
    useLoops(result.stamp);
    if (status_ == EstimatorStatus::kInitializing) {
      initialize(shared, &result);
    } else {
      track(shared, &result);
    }
    for (Keyframe& keyframe : result.keyframes) keyframe.world = world_;
    result.status = status_;
    result.scale_sigma = convergence_.scaleSigma();
    result.rig = tracker_.window().rig;
    if (tracker_.window().refines_rig) result.rig_covariance = tracker_.window().rig_covariance;
    return result;
  }

  /// As at the very first.
  void reset() {
    if (credible_) ++world_;
    tracker_.forgetRig();
    startAnew();
    continuation_.clear();
    credible_.reset();
    extrinsic_is_known_ = options_.extrinsic != ExtrinsicMode::kUnknown;
    calibrator_ =
        TurnCalibrator(calibratorOptions(options_), {options_.T_bc.rotation, options_.td});
    time_offset_.clear();
    rig_check_.clear();
  }

 private:
  /// A new sequence, which goes on from the last credible state.
  void startAnew() {
    if (status_ == EstimatorStatus::kTracking) ++sequence_;
    status_ = EstimatorStatus::kInitializing;
    initializer_.clear();
    initializer_.setExtrinsic(tracker_.window().rig.T_bc);
    stillness_.clear();
    track_watch_.clear();
    tracker_.clear();
    waiting_loops_.clear();
    convergence_.clear();
  }

  /// Hands the loops on that are due. A loop waits for a fixed time after its query keyframe, so
  /// that it does not matter how long recognising the place has taken.
  void useLoops(Stamp now) {
    const auto is_due = [&](const LoopMatch& match) {
      return now >= match.query_stamp + toNanoseconds(kLoopDelay);
    };
    while (!waiting_loops_.empty() && is_due(waiting_loops_.front())) {
      if (status_ == EstimatorStatus::kTracking) tracker_.addLoop(waiting_loops_.front());
      waiting_loops_.pop_front();
    }
  }

  void fail(const std::string& why, std::vector<std::pair<std::string, double>> figures,
            EstimatorResult* result) {
    if (credible_) {
      continuation_.start(credible_->stamp, credible_->state, credible_->covariance);
    }
    startAnew();
    figures.emplace_back("sequence", sequence_);
    result->events.push_back({result->stamp, Severity::kError, "reset",
                              why + "; starting anew from the last credible position",
                              std::move(figures)});
  }

  /// The interval to the frame must be one that can be integrated over.
  void checkInterval(const FrameMeasurements& measurements, EstimatorResult* result) {
    constexpr double kLongestGap = 0.5;  // [s]
    if (measurements.longest_gap <= kLongestGap && !measurements.is_first) return;
    fail("the IMU was silent for too long", {{"gap_s", measurements.longest_gap}}, result);
  }

  /// As known, or as estimated so far; what is left of it is the window's.
  /// Bounded, since frames wait for samples of its length.
  double readout() const {
    constexpr double kLongest = 0.2;  // [s], as rolling_shutter_tr may be
    return std::min(kLongest, std::max(0.0, tracker_.window().rig.readout));
  }

  void undoRollingShutter(FrameMeasurements* measurements) const {
    const SlidingWindow& window = tracker_.window();
    const Eigen::Vector3d bias = window.frames.empty()
                                     ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                     : window.frames.back().state.value().gyroscope_bias;
    std::vector<ImuSample> gyro = measurements->readout;
    for (ImuSample& sample : gyro) sample.angular_velocity -= bias;
    measurements->undone_readout = readout();
    const RollingShutter shutter{measurements->undone_readout, options_.image_height,
                                 window.rig.T_bc.rotation};
    measurements->frame =
        atFirstRow(measurements->frame, shutter, gyro, meanRate(measurements->imu) - bias);
  }

  /// Looks for the time offset, once, where it is to be estimated and may be far from the guess.
  /// Returns whether the frames were timed anew for it, this one included.
  bool searchTimeOffset(const SharedMeasurements& shared, EstimatorResult* result) {
    if (!extrinsic_is_known_) return false;
    const RigCalibration& rig = tracker_.window().rig;
    const std::optional<TimeOffset> found = time_offset_.addFrame(*shared, rig.T_bc.rotation);
    if (!found) return false;
    result->events.push_back(toEvent(result->stamp, *found));
    const double shift = found->td - rig.td;
    if (std::abs(shift) <= found->sigma) return false;
    const RetimedFrames retimed = initializer_.retime(shared, shift);
    if (!retimed.frames.empty()) queue_.rewind(retimed.frames.back()->end, retimed.samples);
    tracker_.setTimeOffset(found->td, found->sigma);
    TurnCalibratorOptions options = calibratorOptions(options_);
    options.prior.td_sigma = found->sigma;
    calibrator_ = TurnCalibrator(options, {rig.T_bc.rotation, found->td});
    return true;
  }

  /// Watches the rig turn, where camera and IMU stand to each other in a way that is not quite
  /// known. Returns whether enough is known of it to begin.
  bool calibrate(const SharedMeasurements& shared, EstimatorResult* result) {
    const RigCalibration& rig = tracker_.window().rig;
    if (searchTimeOffset(shared, result)) return false;
    const std::optional<TurnCalibration> found = calibrator_.addFrame(*shared, rig.td);
    moveEvents(calibrator_.takeEvents(), result);
    if (!found) return extrinsic_is_known_;
    const bool is_new = !extrinsic_is_known_ || rig.T_bc.rotation.angularDistance(found->R_bc) >
                                                    2.0 * found->rotation_sigma;
    constexpr double kTimeShift = 1.5e-3;  // [s]: frames timed by less than that are well timed
    const bool is_shifted = std::abs(found->td - rig.td) > std::max(kTimeShift, found->td_sigma);
    if (!is_new && !is_shifted) return true;
    // Frames before were timed otherwise, and do not go with those to come.
    if (is_shifted) initializer_.clear();
    tracker_.setRig(*found);
    initializer_.setExtrinsic(rig.T_bc);
    if (!std::exchange(extrinsic_is_known_, true)) {
      result->events.push_back(
          {result->stamp,
           Severity::kInfo,
           "extrinsic_found",
           "the camera's rotation in the body frame is known",
           {{"turns", static_cast<double>(found->pairs)}, {"sigma_rad", found->rotation_sigma}}});
    }
    return true;
  }

  void initialize(const SharedMeasurements& shared, EstimatorResult* result) {
    const FrameMeasurements& measurements = *shared;
    result->statistics.features = static_cast<int>(measurements.frame.observations.size());
    continuation_.addFrame(measurements);
    const bool calibrates = options_.extrinsic != ExtrinsicMode::kTrusted || options_.estimate_td;
    if (calibrates && !calibrate(shared, result)) return;
    const bool may_move = !extrinsic_is_known_ || !time_offset_.awaits(result->stamp);
    std::optional<Initialization> initialization = initializer_.addFrame(shared, may_move);
    moveEvents(initializer_.takeEvents(), result);
    if (!initialization) return;
    continuation_.apply(&*initialization);
    status_ = EstimatorStatus::kTracking;
    convergence_.begin(result->stamp, initialization->scale_sigma);
    if (!beginWindow(*initialization, measurements, result)) return;
    continuation_.clear();
    rig_check_.begin(result->stamp);
    result->events.push_back(
        {result->stamp,
         Severity::kInfo,
         "initialized",
         initialization->at_rest ? "initialized at rest" : "initialized moving",
         {{"frames", static_cast<double>(initialization->frames.size())},
          {"sequence", static_cast<double>(sequence_)},
          {"scale_sigma_percent", 100.0 * initialization->scale_sigma}}});
  }

  /// Fills the empty window with first states, and solves it.
  bool beginWindow(const Initialization& initialization, const FrameMeasurements& measurements,
                   EstimatorResult* result) {
    tracker_.start(initialization);
    const NavState first = tracker_.window().frames.back().state.value();
    if (!adjust(first, false, result)) return false;
    report(measurements, result);
    tracker_.keepFirstFrames(sequence_, result);
    return true;
  }

  /// Solves the start again while its scale converges; the window begins anew with a solution that
  /// knows it clearly better, where the body stands now. Returns whether it has.
  bool refineStart(const SharedMeasurements& shared, EstimatorResult* result) {
    if (!convergence_.scaleSigma()) return false;
    initializer_.remember(shared);
    if (!convergence_.isDue(result->stamp)) return false;
    initializer_.setExtrinsic(tracker_.window().rig.T_bc);
    std::optional<Initialization> again = initializer_.solveAgain();
    if (!again) return false;
    const double ratio = again->scale_sigma / *convergence_.scaleSigma();
    if (!convergence_.take(again->scale_sigma)) return false;
    const WindowFrame& before = tracker_.window().frames.back();
    Preintegration imu(options_.imu, before.state.value().accelerometer_bias,
                       before.state.value().gyroscope_bias, tracker_.window().rig.imu);
    imu.integrate(shared->imu);
    moveNewestTo(imu.predict(before.state.value(), tracker_.window().g_w), before.covariance,
                 ratio * ratio, &*again);
    tracker_.clear();
    result->events.push_back({result->stamp,
                              Severity::kInfo,
                              "start_refined",
                              "the start was solved again with more motion",
                              {{"scale_sigma_percent", 100.0 * again->scale_sigma}}});
    beginWindow(*again, *shared, result);
    return true;
  }

  void track(const SharedMeasurements& shared, EstimatorResult* result) {
    if (refineStart(shared, result)) return;
    const FrameMeasurements& measurements = *shared;
    const NavState predicted = tracker_.append(measurements, stillness_.isStill());
    const auto features = static_cast<int>(measurements.frame.observations.size());
    const std::optional<Event> event = track_watch_.addFrame(result->stamp, features);
    if (event) result->events.push_back(*event);
    if (!adjust(predicted, usesMotionOnly(), result)) return;
    report(measurements, result);
    checkRig(result);
    tracker_.slide(sequence_, result);
  }

  /// Asks now and then whether another rig would explain the images and the IMU better.
  void checkRig(EstimatorResult* result) {
    const SlidingWindow& window = tracker_.window();
    const bool is_full = window.frames.size() > static_cast<std::size_t>(options_.window_size);
    if (!is_full || result->statistics.motion_only || convergence_.scaleSigma()) return;
    if (!rig_check_.isDue(window.frames.front().stamp)) return;
    const std::optional<RigScore> score = scoreRig(window, WindowSolverOptions{}.huber);
    if (!score) return;
    std::optional<Event> event = rig_check_.addScore(result->stamp, *score);
    if (event) result->events.push_back(*std::move(event));
  }

  bool usesMotionOnly() const {
    constexpr int kBehind = 3;  // frames
    // While the scale converges every frame must be able to move the whole window.
    if (convergence_.scaleSigma()) return false;
    if (options_.motion_only == MotionOnly::kWhenBehind) return backlog_ >= kBehind;
    return options_.motion_only == MotionOnly::kAlways;
  }

  /// Solves; where that fails or is not credible, starts anew and returns false.
  bool adjust(const NavState& predicted, bool motion_only, EstimatorResult* result) {
    const bool solved = tracker_.adjust(motion_only, result);
    const WindowFrame& newest = tracker_.window().frames.back();
    const std::optional<Failure> failure =
        solved ? detectFailure({}, predicted, newest.state.value(), newest.covariance)
               : Failure{"the window has no solution", "landmarks",
                         static_cast<double>(result->statistics.landmarks)};
    if (!failure) return true;
    fail(failure->reason, {{failure->figure, failure->value}}, result);
    return false;
  }

  void report(const FrameMeasurements& measurements, EstimatorResult* result) {
    const SlidingWindow& window = tracker_.window();
    result->statistics.features = static_cast<int>(measurements.frame.observations.size());
    Odometry odometry;
    odometry.stamp = measurements.frame.stamp;
    odometry.state = window.atImage(window.frames.back());
    odometry.sequence = sequence_;
    reportRate(measurements.imu, &odometry);
    odometry.covariance = window.frames.back().covariance;
    result->odometry = odometry;
    credible_ = odometry;
    result->landmarks = landmarkPoints(window);
    for (const WindowFrame& frame : window.frames) {
      result->window.push_back({frame.stamp, window.atImage(frame)});
    }
  }

  void reportRate(const std::vector<ImuSample>& samples, Odometry* odometry) const {
    if (samples.empty()) return;
    odometry->angular_velocity_b = samples.back().angular_velocity - odometry->state.gyroscope_bias;
    odometry->angular_velocity_variance =
        newestRateVariance(samples, queue_.imuPeriod(), options_.imu);
  }

  EstimatorOptions options_;
  MeasurementQueue queue_;
  TurnCalibrator calibrator_;
  TimeOffsetInitializer time_offset_;
  Initializer initializer_;
  StillnessDetector stillness_;
  ImuPlausibility plausibility_;
  TrackWatch track_watch_;
  RigCheck rig_check_;
  Continuation continuation_;
  WindowTracker tracker_;
  std::optional<Odometry> credible_;  ///< the last that was reported
  EstimatorStatus status_ = EstimatorStatus::kInitializing;
  std::uint32_t sequence_ = 0;
  std::uint32_t world_ = 0;  ///< rises where nothing is carried over
  int backlog_ = 0;
  std::deque<LoopMatch> waiting_loops_;  ///< of keyframes that have just become such
  bool extrinsic_is_known_ = true;
  ScaleConvergence convergence_;
};

Estimator::Estimator(const EstimatorOptions& options) {
  options.validate();
  implementation_ = std::make_unique<Implementation>(options);
}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;

void Estimator::addImu(const ImuSample& sample) { implementation_->addImu(sample); }
void Estimator::addFrame(FeatureFrame frame) { implementation_->addFrame(std::move(frame)); }
void Estimator::addImageStamp(Stamp stamp) { implementation_->addImageStamp(stamp); }
void Estimator::addLoopMatch(const LoopMatch& match) { implementation_->addLoopMatch(match); }
std::optional<EstimatorResult> Estimator::process() { return implementation_->process(); }
void Estimator::setBacklog(int frames) { implementation_->setBacklog(frames); }
std::vector<Event> Estimator::takeInputEvents() { return implementation_->takeInputEvents(); }
void Estimator::reset() { implementation_->reset(); }

}  // namespace vins::estimator
