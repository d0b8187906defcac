#include "vins_estimator/estimator.h"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "vins_estimator/health/stillness.h"
#include "vins_estimator/inertial/measurement_queue.h"
#include "vins_estimator/initialization/initializer.h"
#include "vins_estimator/visual/keyframe_choice.h"
#include "vins_estimator/window/marginalization.h"
#include "vins_estimator/window/outlier_gate.h"
#include "vins_estimator/window/sliding_window.h"
#include "vins_estimator/window/window_solver.h"
#include "vins_estimator/window/window_start.h"

namespace vins {
namespace {

/// Seconds that a piece of work takes, for the statistics.
class StopWatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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
        initializer_(initializerOptions(options)),
        stillness_(initializerOptions(options).stillness) {
    clearWindow();
  }

  void addImu(const ImuSample& sample) { queue_.addImu(sample); }
  void addFrame(const FeatureFrame& frame) { queue_.addFrame(frame); }

  std::optional<EstimatorResult> process() {
    std::optional<FrameMeasurements> measurements = queue_.next(options_.td);
    if (!measurements) return std::nullopt;
    EstimatorResult result;
    result.stamp = measurements->frame.stamp;
    moveEvents(queue_.takeEvents(), &result);
    tellWhatIsNotEstimated(&result);
    if (measurements->restarted) reset();
    if (status_ == EstimatorStatus::kTracking && !isCredible(*measurements, &result)) reset();
    stillness_.addFrame(measurements->frame, measurements->imu);
    if (status_ == EstimatorStatus::kInitializing) {
      initialize(*measurements, &result);
    } else {
      track(*measurements, &result);
    }
    result.status = status_;
    return result;
  }

  void reset() {
    if (status_ == EstimatorStatus::kTracking) ++sequence_;
    status_ = EstimatorStatus::kInitializing;
    initializer_.clear();
    stillness_.clear();
    clearWindow();
  }

 private:
  /// Once: the configuration wants more than there is.
  void tellWhatIsNotEstimated(EstimatorResult* result) {
    const bool wanted = options_.extrinsic != ExtrinsicMode::kTrusted || options_.estimate_td ||
                        options_.rolling_shutter_readout > 0.0;
    if (!wanted || told_) return;
    told_ = true;
    result->events.push_back(
        {result->stamp,
         Severity::kWarning,
         "not_estimated",
         "extrinsic, td and rolling shutter are not estimated yet: they are taken as configured",
         {}});
  }

  void clearWindow() {
    window_ = SlidingWindow{};
    window_.landmarks = Landmarks(options_.pixel_noise);
    window_.T_bc = options_.T_bc;
    window_.g_w = Eigen::Vector3d(0.0, 0.0, -options_.imu.gravity);
  }

  /// The interval to the frame can be integrated over.
  bool isCredible(const FrameMeasurements& measurements, EstimatorResult* result) const {
    constexpr double kLongestGap = 0.5;  // [s]
    if (measurements.longest_gap <= kLongestGap && !measurements.is_first) return true;
    result->events.push_back({result->stamp,
                              Severity::kError,
                              "reset",
                              "the IMU was silent for too long; starting anew",
                              {{"gap_s", measurements.longest_gap}}});
    return false;
  }

  void initialize(const FrameMeasurements& measurements, EstimatorResult* result) {
    result->statistics.features = static_cast<int>(measurements.frame.observations.size());
    const std::optional<Initialization> initialization = initializer_.addFrame(measurements);
    moveEvents(initializer_.takeEvents(), result);
    if (!initialization) return;
    startWindow(*initialization, next_frame_id_, &window_);
    next_frame_id_ += static_cast<FrameId>(initialization->frames.size());
    if (!options_.first_estimates) {
      for (WindowFrame& frame : window_.frames) frame.state.ignoreFirstEstimates();
    }
    status_ = EstimatorStatus::kTracking;
    if (!adjust(result)) return;
    report(measurements, result);
    result->events.push_back(
        {result->stamp,
         Severity::kInfo,
         "initialized",
         initialization->at_rest ? "initialized at rest" : "initialized moving",
         {{"frames", static_cast<double>(initialization->frames.size())}}});
    for (std::size_t i = 0; i + 1 < window_.frames.size(); ++i) makeKeyframe(i, result);
  }

  void track(const FrameMeasurements& measurements, EstimatorResult* result) {
    appendFrame(measurements);
    if (!adjust(result)) return;
    report(measurements, result);
    slide(result);
  }

  void appendFrame(const FrameMeasurements& measurements) {
    const NavState& last = window_.frames.back().state.value();
    Preintegration imu(options_.imu, last.accelerometer_bias, last.gyroscope_bias);
    // Across a gap the motion is guessed at.
    constexpr double kGapNoise = 10.0;
    imu.integrate(measurements.imu, measurements.has_gap ? kGapNoise : 1.0);
    const NavState predicted = imu.predict(last, window_.g_w);
    WindowFrame frame{next_frame_id_++, measurements.frame.stamp, WindowState(predicted),
                      std::move(imu)};
    frame.stands_still = stillness_.isStill();
    if (!options_.first_estimates) frame.state.ignoreFirstEstimates();
    window_.landmarks.addFrame(frame.id, measurements.frame);
    window_.frames.push_back(std::move(frame));
  }

  /// Solves the window; where that fails, starts anew and returns false.
  bool adjust(EstimatorResult* result) {
    triangulateTracks(&window_);
    const StopWatch watch;
    WindowSolverOptions solver;
    solver.max_num_iterations = options_.max_num_iterations;
    solver.max_solver_time = options_.max_solver_time;
    const SolveSummary summary = solveWindow(solver, &window_);
    EstimatorStatistics& statistics = result->statistics;
    statistics.landmarks = summary.landmarks;
    statistics.observations = summary.observations;
    statistics.iterations = summary.iterations;
    statistics.cost_initial = summary.cost_initial;
    statistics.cost_final = summary.cost_final;
    statistics.outliers = removeOutliers({}, &window_);
    statistics.solve_seconds = watch.seconds();
    window_.frames.back().covariance = summary.newest_covariance;
    if (summary.timed_out) {
      result->events.push_back({result->stamp,
                                Severity::kWarning,
                                "solver_time",
                                "max_solver_time has cut a solution short: the machine is too slow",
                                {{"iterations", static_cast<double>(summary.iterations)}}});
    }
    if (summary.usable && isFinite(window_.frames.back().state.value())) return true;
    result->events.push_back({result->stamp,
                              Severity::kError,
                              "reset",
                              "the window has no finite solution; starting anew",
                              {{"landmarks", static_cast<double>(summary.landmarks)}}});
    reset();
    return false;
  }

  void report(const FrameMeasurements& measurements, EstimatorResult* result) {
    result->statistics.features = static_cast<int>(measurements.frame.observations.size());
    Odometry odometry;
    odometry.stamp = measurements.frame.stamp;
    odometry.state = window_.frames.back().state.value();
    odometry.sequence = sequence_;
    if (!measurements.imu.empty()) {
      odometry.angular_velocity_b =
          measurements.imu.back().angular_velocity - odometry.state.gyroscope_bias;
    }
    odometry.covariance = window_.frames.back().covariance;
    result->odometry = odometry;
    result->landmarks = landmarkPoints();
    for (const WindowFrame& frame : window_.frames) {
      result->window.push_back({frame.stamp, frame.state.value()});
    }
  }

  /// Keeps the second newest frame or lets it go, and makes room.
  void slide(EstimatorResult* result) {
    const std::size_t second = window_.frames.size() - 2;
    const bool keep = second == 0 || isKeyframeAt(second);
    result->statistics.keyframe = keep;
    if (!keep) {
      dropFrame(&window_, second);
      return;
    }
    makeKeyframe(second, result);
    if (window_.frames.size() <= static_cast<std::size_t>(options_.window_size)) return;
    const StopWatch watch;
    const WindowFrame& oldest = window_.frames.front();
    result->left.push_back(
        {oldest.keyframe_id, sequence_, oldest.stamp, oldest.state.value().T_wb});
    marginalizeOldest(WindowSolverOptions{}.huber, &window_);
    result->statistics.marginalize_seconds = watch.seconds();
  }

  bool isKeyframeAt(std::size_t index) const {
    const WindowFrame& frame = window_.frames[index];
    const WindowFrame& last = window_.frames[index - 1];
    const Eigen::Quaterniond R_bc = window_.T_bc.rotation;
    const Eigen::Quaterniond R_frame_last = R_bc.conjugate() *
                                            frame.state.value().T_wb.rotation.conjugate() *
                                            last.state.value().T_wb.rotation * R_bc;
    const FrameParallax parallax =
        parallaxBetween(window_.landmarks, last.id, frame.id, R_frame_last);
    KeyframeChoiceOptions choice;
    choice.min_parallax = options_.keyframe_parallax;
    int tracks = 0;
    for (const auto& [id, track] : window_.landmarks.tracks()) tracks += track.isSeenIn(frame.id);
    return isKeyframe(choice, parallax, tracks, toSeconds(frame.stamp - last.stamp));
  }

  void makeKeyframe(std::size_t index, EstimatorResult* result) {
    WindowFrame& frame = window_.frames[index];
    frame.keyframe_id = next_keyframe_id_++;
    Keyframe keyframe;
    keyframe.id = frame.keyframe_id;
    keyframe.sequence = sequence_;
    keyframe.stamp = frame.stamp;
    keyframe.T_wb = frame.state.value().T_wb;
    keyframe.T_bc = window_.T_bc;
    keyframe.covariance = frame.covariance.topLeftCorner<6, 6>();
    const CameraPoses cameras = window_.cameras();
    for (const auto& [id, track] : window_.landmarks.tracks()) {
      if (!track.has_depth) continue;
      for (const TrackObservation& o : track.observations) {
        if (o.frame != frame.id) continue;
        keyframe.points.push_back(
            {id, o.pixel, o.measured.bearing, positionInWorld(track, cameras.at(track.host()))});
      }
    }
    result->keyframes.push_back(std::move(keyframe));
  }

  std::vector<LandmarkPoint> landmarkPoints() const {
    std::vector<LandmarkPoint> points;
    const CameraPoses cameras = window_.cameras();
    for (const auto& [id, track] : window_.landmarks.tracks()) {
      if (!track.has_depth) continue;
      points.push_back({id, positionInWorld(track, cameras.at(track.host()))});
    }
    return points;
  }

  EstimatorOptions options_;
  MeasurementQueue queue_;
  Initializer initializer_;
  StillnessDetector stillness_;
  SlidingWindow window_;
  EstimatorStatus status_ = EstimatorStatus::kInitializing;
  FrameId next_frame_id_ = 0;
  std::int64_t next_keyframe_id_ = 0;
  std::uint32_t sequence_ = 0;
  bool told_ = false;
};

Estimator::Estimator(const EstimatorOptions& options) {
  options.validate();
  implementation_ = std::make_unique<Implementation>(options);
}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;

void Estimator::addImu(const ImuSample& sample) { implementation_->addImu(sample); }
void Estimator::addFrame(const FeatureFrame& frame) { implementation_->addFrame(frame); }
void Estimator::addLoopMatch(const LoopMatch& /*match*/) {}
std::optional<EstimatorResult> Estimator::process() { return implementation_->process(); }
void Estimator::reset() { implementation_->reset(); }

}  // namespace vins
