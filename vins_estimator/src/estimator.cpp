#include "vins_estimator/estimator.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "vins_estimator/health/continuation.h"
#include "vins_estimator/health/failure_detector.h"
#include "vins_estimator/health/stillness.h"
#include "vins_estimator/health/track_watch.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/extrinsic_rotation.h"
#include "vins_estimator/initialization/initializer.h"
#include "vins_estimator/visual/rolling_shutter.h"
#include "window_tracker.h"

namespace vins::estimator {
namespace {

InitializerOptions initializerOptions(const EstimatorOptions& options) {
  InitializerOptions result;
  result.imu = options.imu;
  result.T_bc = options.T_bc;
  result.pixel_noise = options.pixel_noise;
  result.stillness.gravity = options.imu.gravity;
  result.max_frames = options.window_size + 1;
  return result;
}

MeasurementQueueOptions queueOptions() {
  MeasurementQueueOptions options;
  options.max_frames = 200;  // ten seconds without the IMU
  return options;
}

TurnCalibratorOptions calibratorOptions(const EstimatorOptions& options) {
  TurnCalibratorOptions result;
  result.pixel_noise = options.pixel_noise;
  if (options.extrinsic == ExtrinsicMode::kUnknown) result.prior.rotation_sigma = 0.0;
  if (options.extrinsic == ExtrinsicMode::kRefined) {
    result.prior.rotation_sigma = options.extrinsic_rotation_sigma;
  }
  if (options.estimate_td) result.prior.td_sigma = options.td_sigma;
  return result;
}

/// From a keyframe's image to the use of its loop: three images at 20 Hz, in which a place is
/// recognised on any machine that keeps up [s].
constexpr double kLoopDelay = 0.15;

void moveEvents(std::vector<Event> events, EstimatorResult* result) {
  for (Event& event : events) result->events.push_back(std::move(event));
}

/// Mean rate over the samples, as a turn over their time.
Eigen::Vector3d meanRate(const std::vector<ImuSample>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) sum += sample.angular_velocity;
  return samples.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(samples.size()));
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
        initializer_(initializerOptions(options)),
        stillness_(initializerOptions(options).stillness),
        track_watch_(options.min_tracks),
        continuation_(options.imu),
        tracker_(options) {
    reset();
  }

  void addImu(const ImuSample& sample) { queue_.addImu(sample); }
  void addFrame(FeatureFrame frame) { queue_.addFrame(std::move(frame)); }
  void setBacklog(int frames) { backlog_ = frames; }
  void addLoopMatch(const LoopMatch& match) {
    if (status_ == EstimatorStatus::kTracking) waiting_loops_.push_back(match);
  }

  std::optional<EstimatorResult> process() {
    std::optional<FrameMeasurements> measurements =
        queue_.next(tracker_.window().rig.td, options_.rolling_shutter_readout);
    if (!measurements) return std::nullopt;
    EstimatorResult result;
    result.stamp = measurements->frame.stamp;
    moveEvents(queue_.takeEvents(), &result);
    if (measurements->restarted) reset();
    if (status_ == EstimatorStatus::kTracking) checkInterval(*measurements, &result);
    if (options_.rolling_shutter_readout > 0.0) undoRollingShutter(&*measurements);
    const auto shared = std::make_shared<const FrameMeasurements>(*std::move(measurements));
    stillness_.addFrame(shared);
    useLoops(result.stamp);
    if (status_ == EstimatorStatus::kInitializing) {
      initialize(shared, &result);
    } else {
      track(*shared, &result);
    }
    for (Keyframe& keyframe : result.keyframes) keyframe.world = world_;
    result.status = status_;
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
    calibrator_.clear();
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

  void undoRollingShutter(FrameMeasurements* measurements) const {
    const SlidingWindow& window = tracker_.window();
    const Eigen::Vector3d bias = window.frames.empty()
                                     ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                     : window.frames.back().state.value().gyroscope_bias;
    std::vector<ImuSample> gyro = measurements->readout;
    for (ImuSample& sample : gyro) sample.angular_velocity -= bias;
    const RollingShutter shutter{options_.rolling_shutter_readout, options_.image_height,
                                 window.rig.T_bc.rotation};
    measurements->frame =
        atFirstRow(measurements->frame, shutter, gyro, meanRate(measurements->imu) - bias);
  }

  /// Watches the rig turn, where camera and IMU stand to each other in a way that is not quite
  /// known. Returns whether enough is known of it to begin.
  bool calibrate(const FrameMeasurements& measurements, EstimatorResult* result) {
    const RigCalibration& rig = tracker_.window().rig;
    const std::optional<TurnCalibration> found = calibrator_.addFrame(measurements, rig.td);
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
    if (tracker_.window().refines_rig && !calibrate(measurements, result)) return;
    std::optional<Initialization> initialization = initializer_.addFrame(shared);
    moveEvents(initializer_.takeEvents(), result);
    if (!initialization) return;
    continuation_.apply(&*initialization);
    tracker_.start(*initialization);
    status_ = EstimatorStatus::kTracking;
    const NavState first = tracker_.window().frames.back().state.value();
    if (!adjust(first, false, result)) return;
    continuation_.clear();
    report(measurements, result);
    result->events.push_back(
        {result->stamp,
         Severity::kInfo,
         "initialized",
         initialization->at_rest ? "initialized at rest" : "initialized moving",
         {{"frames", static_cast<double>(initialization->frames.size())},
          {"sequence", static_cast<double>(sequence_)}}});
    tracker_.keepFirstFrames(sequence_, result);
  }

  void track(const FrameMeasurements& measurements, EstimatorResult* result) {
    const NavState predicted = tracker_.append(measurements, stillness_.isStill());
    const auto features = static_cast<int>(measurements.frame.observations.size());
    const std::optional<Event> event = track_watch_.addFrame(result->stamp, features);
    if (event) result->events.push_back(*event);
    if (!adjust(predicted, usesMotionOnly(), result)) return;
    report(measurements, result);
    tracker_.slide(sequence_, result);
  }

  bool usesMotionOnly() const {
    constexpr int kBehind = 3;  // frames
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
    odometry.state = window.frames.back().state.value();
    odometry.sequence = sequence_;
    reportRate(measurements.imu, &odometry);
    odometry.covariance = window.frames.back().covariance;
    result->odometry = odometry;
    credible_ = odometry;
    result->landmarks = landmarkPoints(window);
    for (const WindowFrame& frame : window.frames) {
      result->window.push_back({frame.stamp, frame.state.value()});
    }
  }

  /// The newest reading. Where it was interpolated at the frame's time, noise of its two neighbours
  /// is averaged in it.
  void reportRate(const std::vector<ImuSample>& samples, Odometry* odometry) const {
    if (samples.empty()) return;
    odometry->angular_velocity_b = samples.back().angular_velocity - odometry->state.gyroscope_bias;
    const double period = queue_.imuPeriod();
    const double last = samples.size() < 2
                            ? period
                            : toSeconds(samples.back().stamp - samples[samples.size() - 2].stamp);
    const double share = std::min(1.0, last / period);
    const double averaging = share * share + (1.0 - share) * (1.0 - share);
    odometry->angular_velocity_variance = averaging * options_.imu.gyroscopeVariance(period);
  }

  EstimatorOptions options_;
  MeasurementQueue queue_;
  TurnCalibrator calibrator_;
  Initializer initializer_;
  StillnessDetector stillness_;
  TrackWatch track_watch_;
  Continuation continuation_;
  WindowTracker tracker_;
  std::optional<Odometry> credible_;  ///< the last that was reported
  EstimatorStatus status_ = EstimatorStatus::kInitializing;
  std::uint32_t sequence_ = 0;
  std::uint32_t world_ = 0;  ///< rises where nothing is carried over
  int backlog_ = 0;
  std::deque<LoopMatch> waiting_loops_;  ///< of keyframes that have just become such
  bool extrinsic_is_known_ = true;
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
void Estimator::addLoopMatch(const LoopMatch& match) { implementation_->addLoopMatch(match); }
std::optional<EstimatorResult> Estimator::process() { return implementation_->process(); }
void Estimator::setBacklog(int frames) { implementation_->setBacklog(frames); }
void Estimator::reset() { implementation_->reset(); }

}  // namespace vins::estimator
