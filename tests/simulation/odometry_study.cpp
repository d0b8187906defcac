#include "simulation/odometry_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "simulation/builtin_trajectories.h"
#include "simulation/euroc_rig.h"
#include "simulation/imu_simulator.h"
#include "simulation/random.h"
#include "simulation/spline_fit.h"
#include "vins_core/input_error.h"
#include "vins_core/resident_memory.h"
#include "vins_core/trajectory_file.h"
#include "vins_estimator/estimator.h"

namespace vins::simulation {
namespace {

constexpr Stamp kEpoch = 1600000000000000000;  ///< where built-in trajectories begin [ns]
constexpr double kOverhang = 0.02;             ///< IMU samples go on after the last frame [s]

bool isBuiltin(const std::string& name) {
  const std::vector<std::string> names = builtinTrajectoryNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

double shareOfNoise(const std::string& name) {
  return name == "euroc" ? 1.0 : name == "low" ? 0.1 : 0.0;
}

TrajectorySpline makeMotion(const OdometryStudyOptions& options, std::uint64_t seed) {
  if (!isBuiltin(options.trajectory)) {
    return fitSpline(readTrajectoryFile(options.trajectory)).spline;
  }
  const double end = options.features.start + options.features.duration;
  return makeBuiltinTrajectory(options.trajectory, seed, end, options.T_bc, kEpoch);
}

ImuOptions imuOptions(const OdometryStudyOptions& options, std::uint64_t seed) {
  const double share = shareOfNoise(options.imu_noise);
  ImuOptions imu;
  imu.rate = options.imu_rate;
  imu.time_offset = options.time_offset;
  imu.noise_free = share == 0.0;
  // Also without noise a filter needs densities to assume.
  const double density = share == 1.0 ? 1.0 : 0.1;
  imu.noise.accelerometer_noise *= density;
  imu.noise.gyroscope_noise *= density;
  imu.noise.accelerometer_walk *= density;
  imu.noise.gyroscope_walk *= density;
  Random random(seed, "imu initial bias");
  imu.initial_accelerometer_bias = 0.1 * share * random.normal3();
  imu.initial_gyroscope_bias = 0.03 * share * random.normal3();
  if (options.vibration > 0.0) {
    imu.vibrations = {{90.0, 4.0, options.vibration, 0.04 * options.vibration}};
  }
  return imu;
}

ImuRecording makeImu(const OdometryStudyOptions& options, const TrajectorySpline& motion,
                     std::uint64_t seed) {
  const Stamp begin = motion.epoch() + toNanoseconds(options.features.start);
  const Stamp end = begin + toNanoseconds(options.features.duration + kOverhang);
  // The first sample is not after the first frame, whichever way the clocks differ.
  const double early = std::max(0.0, std::ceil(-options.time_offset * options.imu_rate));
  return simulateImu(motion, begin - toNanoseconds(early / options.imu_rate),
                     end + toNanoseconds(options.time_offset), imuOptions(options, seed), seed);
}

estimator::EstimatorOptions estimatorOptions(const OdometryStudyOptions& options,
                                             std::uint64_t seed) {
  estimator::EstimatorOptions estimator = options.estimator;
  estimator.imu = imuOptions(options, seed).noise;
  estimator.pixel_noise = std::max(options.features.pixel_noise, 0.1);
  estimator.image_height = eurocCamera(0)->imageSize().height;
  return estimator;
}

/// A flight that is being followed.
class Flight {
 public:
  Flight(const OdometryStudyOptions& options, std::uint64_t seed)
      : keep_every_(std::max<std::size_t>(1, options.keep_every)),
        propagates_(options.propagates),
        motion_(makeMotion(options, seed)),
        imu_(makeImu(options, motion_, seed)),
        offset_(toNanoseconds(options.time_offset)),
        blackouts_(options.blackouts),
        samples_(withFaults(imu_.samples, motion_.epoch() + toNanoseconds(options.features.start),
                            options.imu_faults)),
        estimator_(estimatorOptions(options, seed)),
        propagator_(imuOptions(options, seed).noise),
        features_(motion_, eurocCamera(0), options.T_bc, withSeed(options.features, seed)) {
    run_.seed = seed;
    run_.true_rig = {options.T_bc, options.time_offset};
  }

  OdometryRun fly() {
    while (auto frame = features_.next()) {
      if (run_.frames++ == 0) run_.begin = frame->stamp;
      const double seconds = toSeconds(frame->stamp - run_.begin);
      if (contains(blackouts_, seconds)) frame->observations.clear();
      const auto start = std::chrono::steady_clock::now();
      addSamplesUpTo(frame->stamp);
      estimator_.addFrame(*frame);
      work();
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      run_.frame_seconds.push_back(elapsed.count());
      if (seconds >= 60.0 * (1.0 + static_cast<double>(run_.megabytes.size()))) {
        run_.megabytes.push_back(residentMegabytes());
      }
    }
    addSamplesUpTo(samples_.back().arrival);
    work();
    return std::move(run_);
  }

 private:
  static FeatureSimulatorOptions withSeed(FeatureSimulatorOptions options, std::uint64_t seed) {
    options.seed = seed;
    return options;
  }

  void addSamplesUpTo(Stamp stamp) {
    for (; next_sample_ < samples_.size(); ++next_sample_) {
      if (samples_[next_sample_].arrival > stamp) return;
      estimator_.addImu(samples_[next_sample_].sample);
      if (propagates_) propagate(samples_[next_sample_].sample);
    }
  }

  void propagate(const ImuSample& sample) {
    const std::optional<estimator::PropagatedState> state = propagator_.addImu(sample);
    if (!state) return;
    const Stamp stamp = state->stamp - offset_;
    run_.propagated.push_back({*state, truthAt(stamp), rateAt(stamp)});
  }

  void work() {
    while (const auto result = estimator_.process()) {
      run_.rig = result->rig;
      run_.rig_covariance = result->rig_covariance;
      run_.events.insert(run_.events.end(), result->events.begin(), result->events.end());
      if (result->odometry && odometries_++ % keep_every_ == 0) keep(*result);
      if (result->odometry && propagates_) {
        propagator_.setState(result->odometry->stamp + toNanoseconds(result->rig.td),
                             result->odometry->state, result->odometry->covariance);
      }
    }
  }

  void keep(const estimator::EstimatorResult& result) {
    const Stamp stamp = result.odometry->stamp;
    OdometrySample sample{*result.odometry, truthAt(stamp), std::nullopt, rateAt(stamp)};
    // After a reset the odometry goes on where it was, and its covariance tells how well.
    const bool is_first = run_.samples.empty();
    if (is_first && result.window.empty()) {
      sample.gauge = Gauge{sample.estimate.state.T_wb, sample.truth.T_wb};
    } else if (is_first) {
      const estimator::StampedNavState& oldest = result.window.front();
      sample.gauge = Gauge{oldest.state.T_wb, truthAt(oldest.stamp).T_wb};
    }
    run_.samples.push_back(sample);
  }

  Eigen::Vector3d rateAt(Stamp stamp) const {
    return motion_.at(motion_.secondsAt(stamp)).angular_velocity_b;
  }

  estimator::NavState truthAt(Stamp stamp) const {
    const MotionState motion = motion_.at(motion_.secondsAt(stamp));
    const auto after =
        std::lower_bound(imu_.biases.begin(), imu_.biases.end(), stamp + offset_,
                         [](const ImuBias& bias, Stamp value) { return bias.stamp < value; });
    const ImuBias& bias = after == imu_.biases.end() ? imu_.biases.back() : *after;
    return {motion.T_wb, motion.velocity_w, bias.accelerometer, bias.gyroscope};
  }

  std::size_t keep_every_;
  bool propagates_;
  std::size_t odometries_ = 0;
  TrajectorySpline motion_;
  ImuRecording imu_;
  Stamp offset_;
  std::vector<TimeInterval> blackouts_;
  std::vector<ArrivedSample> samples_;
  estimator::Estimator estimator_;
  estimator::Propagator propagator_;
  FeatureSimulator features_;
  std::size_t next_sample_ = 0;
  OdometryRun run_;
};

}  // namespace

OdometryStudyOptions::OdometryStudyOptions() : T_bc(eurocCameraInBody(0)) { estimator.T_bc = T_bc; }

void OdometryStudyOptions::validate() const {
  features.validate();
  if (shareOfNoise(imu_noise) == 0.0 && imu_noise != "none") {
    throw InputError("imu noise: found '" + imu_noise + "'; allowed: euroc, low, none");
  }
  if (!isBuiltin(trajectory) && !std::filesystem::exists(trajectory)) {
    std::string names;
    for (const std::string& name : builtinTrajectoryNames()) names += ", " + name;
    throw InputError("trajectory: found '" + trajectory + "'; allowed: a file" + names);
  }
  imuOptions(*this, 1).validate();
  estimatorOptions(*this, 1).validate();
}

OdometryRun runOdometry(const OdometryStudyOptions& options, std::uint64_t seed) {
  options.validate();
  return Flight(options, seed).fly();
}

}  // namespace vins::simulation
