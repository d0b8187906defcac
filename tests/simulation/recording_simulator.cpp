#include "simulation/recording_simulator.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "camera_model/camera_file.h"
#include "simulation/builtin_trajectories.h"
#include "simulation/euroc_rig.h"
#include "simulation/moving_objects.h"
#include "simulation/random.h"
#include "simulation/scene_catalogue.h"
#include "simulation/spline_fit.h"
#include "vins_core/input_error.h"
#include "vins_core/trajectory_file.h"

namespace vins::simulation {
namespace {

constexpr Stamp kEpoch = 1600000000000000000;  ///< where built-in trajectories begin [ns]
constexpr double kDefaultDuration = 60.0;      ///< of built-in trajectories [s]
constexpr double kGroundTruthRate = 200.0;     ///< [Hz]
constexpr double kImuOverhang = 0.02;          ///< IMU samples go on after the last image [s]

/// The motion, and the part of it that is recorded, in its seconds.
struct Motion {
  TrajectorySpline spline;
  double begin;
  double end;
};

[[noreturn]] void fail(const std::string& what, double found, const std::string& allowed) {
  std::ostringstream message;
  message << what << ": found " << found << "; allowed: " << allowed;
  throw InputError(message.str());
}

bool isBuiltin(const std::string& name) {
  const std::vector<std::string> names = builtinTrajectoryNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

Pose cameraInBody(const RecordingOptions& options) {
  return options.own_rig ? options.own_rig->truth.T_bc.front() : eurocCameraInBody(0);
}

Motion motionOfFile(const RecordingOptions& options, std::ostream* description) {
  const Trajectory trajectory = readTrajectoryFile(options.trajectory);
  const double end =
      options.start + options.duration.value_or(trajectory.duration() - options.start);
  if (!(options.start < end && end <= trajectory.duration())) {
    std::ostringstream message;
    message << options.trajectory << ": asked for seconds " << options.start << " to " << end
            << "; it has 0 to " << trajectory.duration();
    throw InputError(message.str());
  }
  const SplineFit fit = fitSpline(trajectory);
  *description << "trajectory: " << options.trajectory << "\n" << fit << "\n";
  return {fit.spline, options.start, end};
}

Motion makeMotion(const RecordingOptions& options, std::ostream* description) {
  if (!isBuiltin(options.trajectory)) {
    if (std::filesystem::exists(options.trajectory)) return motionOfFile(options, description);
    std::string names;
    for (const std::string& name : builtinTrajectoryNames()) names += ", " + name;
    throw InputError("trajectory: found '" + options.trajectory + "'; allowed: a file" + names);
  }
  *description << "trajectory: " << options.trajectory << "\n";
  const double end = options.start + options.duration.value_or(kDefaultDuration);
  return {
      makeBuiltinTrajectory(options.trajectory, options.seed, end, cameraInBody(options), kEpoch),
      options.start, end};
}

std::vector<Eigen::Vector3d> positionsOf(const Motion& motion) {
  std::vector<Eigen::Vector3d> positions;
  for (double t = motion.begin; t <= motion.end; t += 0.1) {
    positions.push_back(motion.spline.poseAt(t).position);
  }
  return positions;
}

std::string chooseScene(const RecordingOptions& options,
                        const std::vector<Eigen::Vector3d>& positions) {
  if (!options.scene.empty()) return options.scene;
  if (isBuiltin(options.trajectory)) return sceneOfBuiltinTrajectory(options.trajectory);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p_w : positions) box.extend(p_w);
  // EuRoC's flights in the Vicon room stay within 6 m, those in the machine hall do not.
  return box.sizes().maxCoeff() > 8.0 ? "fitted_hall" : "fitted_room";
}

std::shared_ptr<const Scene> buildScene(const RecordingOptions& options, const Motion& motion,
                                        std::ostream* description) {
  const std::vector<Eigen::Vector3d> positions = positionsOf(motion);
  const std::string name = chooseScene(options, positions);
  *description << "scene: " << name << ", " << options.moving_objects << " moving objects\n";
  const bool fitted = name == "fitted_room" || name == "fitted_hall";
  const FittedStyle style = name == "fitted_hall" ? FittedStyle::kHall : FittedStyle::kRoom;
  const Scene scene =
      fitted ? sceneFittedTo(positions, options.seed, style) : makeScene(name, options.seed);
  return std::make_shared<const Scene>(withMovingObjects(scene, options.moving_objects,
                                                         motion.spline, cameraInBody(options),
                                                         motion.begin, motion.end, options.seed));
}

ImuOptions imuOptions(const RecordingOptions& options) {
  if (options.own_rig) return options.own_rig->imu;
  ImuOptions imu;
  imu.rate = options.imu_rate;
  imu.time_offset = options.time_offset;
  imu.noise_free = options.imu_noise == "none";
  const double share = imu.noise_free ? 0.0 : options.imu_noise == "low" ? 0.1 : 1.0;
  if (options.imu_noise != "euroc") {
    // Also without noise a filter needs densities to assume.
    imu.noise.accelerometer_noise *= 0.1;
    imu.noise.gyroscope_noise *= 0.1;
    imu.noise.accelerometer_walk *= 0.1;
    imu.noise.gyroscope_walk *= 0.1;
  }
  Random random(options.seed, "imu initial bias");
  imu.initial_accelerometer_bias = 0.1 * share * random.normal3();
  imu.initial_gyroscope_bias = 0.03 * share * random.normal3();
  if (options.vibration > 0.0) {
    imu.vibrations = {{90.0, 4.0, options.vibration, 0.04 * options.vibration}};
  }
  return imu;
}

Rig makeRig(const RecordingOptions& options) {
  if (options.own_rig) return options.own_rig->truth;
  Rig rig;
  for (int camera = 0; camera < (options.stereo ? 2 : 1); ++camera) {
    const bool is_own = !options.camera_file.empty();
    rig.cameras.push_back(is_own ? camera_model::readCameraFile(options.camera_file)
                                 : eurocCamera(camera));
    rig.T_bc.push_back(eurocCameraInBody(camera));
  }
  rig.noise = imuOptions(options).noise;
  // The recorded sensor vibrates: densities that VINS-Mono assumes for EuRoC.
  if (!options.recorded_imu.empty()) rig.noise = {0.08, 0.004, 4.0e-5, 2.0e-6, 9.81007};
  rig.time_offset = options.time_offset;
  rig.rolling_shutter_readout = options.image.rolling_shutter_readout_s;
  return rig;
}

/// As handed out: with errors, and with td as something to find out.
Rig handedOut(const Rig& rig, const RecordingOptions& options) {
  if (options.own_rig) return options.own_rig->handed_out;
  Rig handed = withCalibrationError(rig, options.calibration_error, options.seed);
  handed.estimate_time_offset = rig.time_offset != 0.0;
  handed.time_offset = 0.0;
  return handed;
}

void addImu(const RecordingOptions& options, Stamp begin, Stamp end,
            SimulatedRecording* recording) {
  const double time_offset = imuOptions(options).time_offset;
  const Stamp offset = toNanoseconds(time_offset);
  const Stamp last = end + offset + toNanoseconds(kImuOverhang);
  std::vector<ImuSample> samples;
  if (options.recorded_imu.empty()) {
    // The first sample lies on the grid of the images, not after the first of them.
    const ImuOptions imu_options = imuOptions(options);
    const double before = std::max(0.0, std::ceil(-time_offset * imu_options.rate));
    const Stamp first = begin - toNanoseconds(before / imu_options.rate);
    const ImuRecording imu = simulateImu(recording->motion, first, last, imu_options, options.seed);
    samples = imu.samples;
    recording->biases = imu.biases;
  } else {
    for (const ImuSample& sample : options.recorded_imu) {
      if (sample.stamp >= begin + offset && sample.stamp <= last) samples.push_back(sample);
    }
    if (samples.empty()) throw InputError("recorded IMU: no sample in the span of the recording");
  }
  recording->imu = withFaults(samples, begin, options.faults.imu);
}

void addImages(const RecordingOptions& options, const Motion& motion, Stamp begin, Stamp end,
               const std::shared_ptr<const Scene>& scene, SimulatedRecording* recording) {
  FrameTiming timing = options.timing;
  timing.rate = options.image_rate;
  for (const FrameInstant& frame : frameInstants(timing, toSeconds(end - begin), options.seed)) {
    if (contains(options.faults.frames.dropped, frame.taken_s)) continue;
    recording->image_stamps.push_back(begin + toNanoseconds(frame.stamped_s));
    recording->image_times.push_back(motion.spline.secondsAt(begin + toNanoseconds(frame.taken_s)));
  }
  ImageOptions image = options.image;
  image.blackouts.clear();
  if (options.auto_exposure) {
    const Pose T_bc = recording->true_rig.T_bc.front();
    const auto T_wc = [&](double t_s) { return motion.spline.poseAt(t_s) * T_bc; };
    image.exposures = planExposure(*scene, *recording->true_rig.cameras.front(), T_wc, motion.begin,
                                   motion.end, *options.auto_exposure);
  }
  for (const TimeInterval& blackout : options.faults.frames.blackouts) {
    image.blackouts.push_back({blackout.begin_s + motion.begin, blackout.end_s + motion.begin});
  }
  const Rig& rig = recording->true_rig;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    recording->cameras.emplace_back(scene, rig.cameras[i], rig.T_bc[i], image, options.seed,
                                    "cam" + std::to_string(i));
  }
}

void addGroundTruth(Stamp begin, Stamp end, SimulatedRecording* recording) {
  for (int i = 0;; ++i) {
    const Stamp stamp = begin + toNanoseconds(i / kGroundTruthRate);
    if (stamp > end) return;
    const TrajectorySpline& motion = recording->motion;
    recording->ground_truth.append({stamp, motion.poseAt(motion.secondsAt(stamp))});
  }
}

}  // namespace

void RecordingOptions::validate() const {
  if (!(start >= 0.0)) fail("start", start, "at least 0 s");
  if (duration && !(*duration >= 0.5)) fail("duration", *duration, "at least 0.5 s");
  if (!(image_rate >= 0.1 && image_rate <= 1000.0)) fail("rate", image_rate, "0.1 to 1000 Hz");
  if (!(std::abs(time_offset) <= 0.2)) fail("td", time_offset, "-0.2 to 0.2 s");
  if (!(vibration >= 0.0)) fail("vibration", vibration, "at least 0 m/s^2");
  if (moving_objects < 0) fail("moving objects", moving_objects, "at least 0");
  if (imu_noise != "euroc" && imu_noise != "low" && imu_noise != "none") {
    throw InputError("imu noise: found '" + imu_noise + "'; allowed: euroc, low, none");
  }
  if (!recorded_imu.empty() && isBuiltin(trajectory)) {
    throw InputError("recorded IMU: found the built-in trajectory '" + trajectory +
                     "'; allowed: the file of the ground truth of that flight");
  }
  imuOptions(*this).validate();
  timing.validate();
  if (auto_exposure) auto_exposure->validate();
  image.validate();
}

cv::Mat SimulatedRecording::render(std::size_t camera, std::size_t index) const {
  const auto pose_at = [this](double t_s) { return motion.poseAt(t_s); };
  return cameras[camera].render(pose_at, image_times[index], index);
}

SimulatedRecording simulateRecording(const RecordingOptions& options) {
  options.validate();
  std::ostringstream description;
  Motion motion = makeMotion(options, &description);
  const auto scene = buildScene(options, motion, &description);
  // The poses of a recorded flight are of the IMU's clock, which is ahead of the camera's by td.
  if (!options.recorded_imu.empty()) {
    motion.spline = motion.spline.shiftedBy(-toNanoseconds(options.time_offset));
  } else {
    description << imuOptions(options);
  }
  const Rig rig = makeRig(options);
  SimulatedRecording recording{motion.spline,           {}, {}, {}, {}, {}, rig,
                               handedOut(rig, options), "", {}};
  const Stamp begin = motion.spline.epoch() + toNanoseconds(motion.begin);
  const Stamp end = motion.spline.epoch() + toNanoseconds(motion.end);
  addImu(options, begin, end, &recording);
  addGroundTruth(begin, end, &recording);
  addImages(options, motion, begin, end, scene, &recording);
  recording.description = description.str();
  return recording;
}

std::string toText(const std::vector<ImuBias>& biases) {
  std::ostringstream text;
  text.precision(9);
  text << "# stamp [ns] accelerometer x y z [m/s^2] gyroscope x y z [rad/s]\n";
  for (const ImuBias& bias : biases) {
    text << bias.stamp;
    for (int i = 0; i < 3; ++i) text << " " << bias.accelerometer[i];
    for (int i = 0; i < 3; ++i) text << " " << bias.gyroscope[i];
    text << "\n";
  }
  return text.str();
}

}  // namespace vins::simulation
