// Simulates a recording of a camera-IMU rig, with ground truth, as a ROS bag.

#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "simulation/builtin_trajectories.h"
#include "simulation/household_recording.h"
#include "simulation/recording_simulator.h"
#include "vins_core/input_error.h"
#include "vins_core/interrupt.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"
#include "vins_core/trajectory_file.h"
#include "vins_pipeline/asl_folder.h"
#include "vins_pipeline/bag_writer.h"
#include "vins_pipeline/message_schedule.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;
namespace sim = vins::simulation;

namespace {

using Texts = std::vector<std::string>;

template <typename T>
po::typed_value<T>* withDefault(const T& value) {
  return po::value<T>()->default_value(value);
}

void addMotionOptions(po::options_description* options) {
  std::string names;
  for (const std::string& name : sim::builtinTrajectoryNames()) names += name + ", ";
  auto add = options->add_options();
  add("output,o", po::value<std::string>()->required(), "bag to write");
  add("preset", withDefault<std::string>(""),
      "household: a walk through a room with a consumer's device, all of which the seed draws; "
      "only --seed, --duration (35 s) and --threads go with it");
  add("trajectory", withDefault<std::string>("hall_loop"),
      (names + "or a file of poses (TUM, EuRoC csv)").c_str());
  add("scene", withDefault<std::string>(""),
      "room, hall, corridor, corridor_alike, yard, household, fitted_room, fitted_hall; otherwise "
      "what suits the trajectory");
  add("start", withDefault(0.0), "where in the trajectory to begin [s]");
  add("duration", po::value<double>(), "[s]; 60, or to the end of a file");
  add("seed", withDefault<std::uint64_t>(1), "same seed, same bytes");
  add("moving-objects", withDefault(0), "swinging blocks in the camera's view");
}

void addImuOptions(po::options_description* options) {
  auto add = options->add_options();
  add("imu-rate", withDefault(200.0), "[Hz]");
  add("imu-noise", withDefault<std::string>("euroc"), "euroc, low (a tenth of it) or none");
  add("vibration", withDefault(0.0), "of the rotors, 90 Hz, root mean square [m/s^2]");
  add("recorded-imu", withDefault<std::string>(""),
      "EuRoC csv of the flight whose ground truth is --trajectory: take these samples");
  add("td", withDefault(0.0), "t_imu = t_cam + td [s]; handed out as 0, to be estimated");
}

void addCameraOptions(po::options_description* options) {
  const sim::ImageOptions image;
  auto add = options->add_options();
  add("camera", withDefault<std::string>(""), "camera file; otherwise EuRoC's cameras");
  add("stereo", po::bool_switch(), "also /cam1/image_raw");
  add("rate", withDefault(20.0), "images per second");
  add("exposure", withDefault(image.exposure_s), "[s]");
  add("rolling-shutter", withDefault(0.0), "read-out of all rows [s]; 0: global shutter");
  add("gain", withDefault(image.gain), "gray values are 255 times light times this");
  add("gain-drift", withDefault(image.gain_drift), "deviation of the gain's logarithm");
  add("read-noise", withDefault(image.read_noise_dn), "[gray values]");
  add("threads", withDefault(image.threads), "for rendering; the bag does not depend on it");
  add("calibration-error", withDefault(0.0),
      "errors of the rig as handed out, in sigmas of: focal length 0.1 %, centre 0.5 px, "
      "distortion 1 %, extrinsic 0.2 deg and 2 mm");
}

void addFaultOptions(po::options_description* options) {
  auto add = options->add_options();
  add("faults", po::bool_switch(),
      "the fault bag: IMU gaps of 50 ms at 12 s and of 200 ms at 18 s, NaN at 24 s, a sample twice "
      "at 26 s, two reversed at 28 s, no images from 32 to 32.2 s, blackout from 38 to 39 s");
  add("blackout", po::value<Texts>()->composing(),
      "START:DURATION [s] of black images; repeatable");
  add("drop-frames", po::value<Texts>()->composing(), "START:DURATION [s] without images");
  add("imu-gap", po::value<Texts>()->composing(), "START:DURATION [s] without IMU samples");
}

po::options_description describeOptions() {
  po::options_description options;
  addMotionOptions(&options);
  addImuOptions(&options);
  addCameraOptions(&options);
  addFaultOptions(&options);
  return options;
}

void readIntervals(const po::variables_map& values, const std::string& option,
                   std::vector<sim::TimeInterval>* intervals) {
  if (values.count(option) == 0) return;
  const auto more = sim::parseIntervals("--" + option, values[option].as<Texts>());
  intervals->insert(intervals->end(), more.begin(), more.end());
}

sim::Faults readFaults(const po::variables_map& values) {
  sim::Faults faults;
  if (values["faults"].as<bool>()) {
    faults = sim::faultBagPreset();
    const double needed = sim::kFaultBagDuration;
    if (values.count("duration") > 0 && values["duration"].as<double>() < needed) {
      throw vins::InputError("--faults: found a duration of " +
                             std::to_string(values["duration"].as<double>()) +
                             " s; allowed: at least " + std::to_string(needed) + " s");
    }
  }
  readIntervals(values, "blackout", &faults.frames.blackouts);
  readIntervals(values, "drop-frames", &faults.frames.dropped);
  readIntervals(values, "imu-gap", &faults.imu.gaps);
  return faults;
}

sim::ImageOptions readImageOptions(const po::variables_map& values) {
  sim::ImageOptions image;
  image.exposure_s = values["exposure"].as<double>();
  image.rolling_shutter_readout_s = values["rolling-shutter"].as<double>();
  image.gain = values["gain"].as<double>();
  image.gain_drift = values["gain-drift"].as<double>();
  image.read_noise_dn = values["read-noise"].as<double>();
  image.threads = values["threads"].as<int>();
  return image;
}

/// Throws InputError for an unknown preset, and for an option that the preset would override.
sim::RecordingOptions readPreset(const po::variables_map& values) {
  const std::string preset = values["preset"].as<std::string>();
  if (preset != "household") {
    throw vins::InputError("--preset: found '" + preset + "'; allowed: household");
  }
  const std::set<std::string> allowed = {"preset", "output", "seed", "duration", "threads"};
  for (const auto& [name, value] : values) {
    if (value.defaulted() || allowed.count(name) > 0) continue;
    throw vins::InputError("--preset household: found --" + name +
                           "; allowed: --seed, --duration, --threads");
  }
  const double duration = values.count("duration") > 0 ? values["duration"].as<double>() : 35.0;
  auto options = sim::householdRecording(values["seed"].as<std::uint64_t>(), duration);
  options.image.threads = values["threads"].as<int>();
  return options;
}

sim::RecordingOptions readOptions(const po::variables_map& values) {
  if (!values["preset"].as<std::string>().empty()) return readPreset(values);
  sim::RecordingOptions options;
  options.trajectory = values["trajectory"].as<std::string>();
  options.scene = values["scene"].as<std::string>();
  options.start = values["start"].as<double>();
  if (values.count("duration") > 0) options.duration = values["duration"].as<double>();
  options.seed = values["seed"].as<std::uint64_t>();
  options.camera_file = values["camera"].as<std::string>();
  options.stereo = values["stereo"].as<bool>();
  options.image_rate = values["rate"].as<double>();
  options.imu_rate = values["imu-rate"].as<double>();
  options.imu_noise = values["imu-noise"].as<std::string>();
  options.vibration = values["vibration"].as<double>();
  options.time_offset = values["td"].as<double>();
  options.calibration_error = values["calibration-error"].as<double>();
  options.moving_objects = values["moving-objects"].as<int>();
  options.faults = readFaults(values);
  options.image = readImageOptions(values);
  const std::string imu_file = values["recorded-imu"].as<std::string>();
  if (!imu_file.empty()) options.recorded_imu = vins::pipeline::readImuCsv(imu_file);
  return options;
}

/// The streams of the bag; at equal times their messages come in this order.
enum Stream : std::size_t { kImu, kGroundTruth, kCamera0, kCamera1 };

std::vector<vins::pipeline::ScheduledMessage> scheduleOf(const sim::SimulatedRecording& recording) {
  std::vector<std::vector<vins::Stamp>> arrivals(kCamera0 + recording.cameras.size());
  for (const auto& sample : recording.imu) arrivals[kImu].push_back(sample.arrival);
  for (const auto& pose : recording.ground_truth.poses()) {
    arrivals[kGroundTruth].push_back(pose.stamp);
  }
  for (std::size_t stream = kCamera0; stream < arrivals.size(); ++stream) {
    arrivals[stream] = recording.image_stamps;
  }
  return vins::pipeline::inOrderOfArrival(arrivals);
}

void write(const sim::SimulatedRecording& recording,
           const vins::pipeline::ScheduledMessage& message, vins::pipeline::BagWriter* bag) {
  if (message.stream == kImu) {
    bag->writeImu(message.arrival, recording.imu[message.index].sample);
  } else if (message.stream == kGroundTruth) {
    const vins::StampedPose& pose = recording.ground_truth.poses()[message.index];
    bag->writeGroundTruth(message.arrival, pose.stamp, pose.T_wb);
  } else {
    const bool is_first = message.stream == kCamera0;
    bag->writeImage(is_first ? vins::pipeline::topic::kCamera0 : vins::pipeline::topic::kCamera1,
                    message.arrival, message.arrival,
                    recording.render(message.stream - kCamera0, message.index));
  }
}

/// False where it was interrupted.
bool writeMessages(const sim::SimulatedRecording& recording, vins::Interrupt* interrupt,
                   vins::pipeline::BagWriter* bag) {
  const auto messages = scheduleOf(recording);
  const std::size_t image_count = recording.image_stamps.size() * recording.cameras.size();
  auto bar = vins::ProgressBar::onStandardError("rendering", image_count);
  std::size_t images = 0;
  for (const vins::pipeline::ScheduledMessage& message : messages) {
    if (interrupt->isRequested()) return false;
    write(recording, message, bag);
    if (message.stream >= kCamera0) bar.update(++images);
  }
  bar.finish();
  return true;
}

/// Ground truth, biases and the rig, as text files beside the bag. The true rig has a file of its
/// own where it is not the one handed out.
void writeTexts(const sim::SimulatedRecording& recording, const std::string& stem) {
  std::string poses = "# timestamp [s] tx ty tz [m] qx qy qz qw: body (IMU) in the world\n";
  for (const vins::StampedPose& pose : recording.ground_truth.poses()) {
    poses += vins::toTumLine(pose) + "\n";
  }
  vins::writeTextFile(stem + "_groundtruth.txt", poses);
  if (!recording.biases.empty()) {
    vins::writeTextFile(stem + "_imu_biases.txt", sim::toText(recording.biases));
  }
  for (std::size_t camera = 0; camera < recording.cameras.size(); ++camera) {
    const std::string end = camera == 0 ? ".yaml" : "_cam1.yaml";
    const std::string handed_out = sim::toVinsYaml(recording.rig, camera);
    const std::string truth = sim::toVinsYaml(recording.true_rig, camera);
    vins::writeTextFile(stem + "_rig" + end, handed_out);
    if (truth != handed_out) vins::writeTextFile(stem + "_true_rig" + end, truth);
  }
}

vins::ToolExit simulate(const po::variables_map& values) {
  const fs::path bag = values["output"].as<std::string>();
  const auto start = std::chrono::steady_clock::now();
  const sim::SimulatedRecording recording = sim::simulateRecording(readOptions(values));
  std::cout << recording.description << std::flush;
  const std::string stem = (bag.parent_path() / bag.stem()).string();
  {
    // Before the renderer's threads are made, which take over what is held back.
    vins::Interrupt interrupt;
    vins::pipeline::BagWriter writer(bag.string());
    if (!writeMessages(recording, &interrupt, &writer)) {
      std::cerr << "\nsimulate_bag: interrupted; " << bag.string() << " was not written\n";
      return vins::ToolExit::kInterrupted;
    }
    // The bag comes last: where it is, all of it is.
    writeTexts(recording, stem);
    writer.finish();
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::cout << "written: " << bag.string() << ", " << static_cast<double>(fs::file_size(bag)) / 1e6
            << " MB, " << recording.ground_truth.duration() << " s of flight in " << elapsed.count()
            << " s; " << stem << "_groundtruth.txt, " << stem << "_rig.yaml beside it\n";
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "simulate_bag",
      "Simulates a recording of a camera-IMU rig, with ground truth, as a ROS bag.\n"
      "Example: simulate_bag -o hall.bag --trajectory hall_loop --duration 60\n"
      "Beside hall.bag: hall_groundtruth.txt, hall_imu_biases.txt, hall_rig.yaml.\n",
      describeOptions(),
      {},
      "Exit code: 0 written, 1 bad input or no room, 130 interrupted: then nothing is written.\n"};
  return vins::runTool(argc, argv, tool, simulate);
}
