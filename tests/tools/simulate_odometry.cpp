// Follows simulated flights with the estimator, at the level of features: many seeds in a minute.

#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "simulation/builtin_trajectories.h"
#include "simulation/odometry_study.h"
#include "vins_core/input_error.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"
#include "vins_core/so3.h"
#include "vins_core/text_file.h"

namespace po = boost::program_options;
namespace sim = vins::simulation;

namespace {

using Texts = std::vector<std::string>;

template <typename T>
po::typed_value<T>* withDefault(const T& value) {
  return po::value<T>()->default_value(value);
}

void addFlightOptions(po::options_description* options) {
  const sim::FeatureSimulatorOptions features;
  std::string names;
  for (const std::string& name : sim::builtinTrajectoryNames()) names += name + ", ";
  auto add = options->add_options();
  add("trajectory", withDefault<std::string>("hall_loop"),
      (names + "or a file of poses (TUM, EuRoC csv)").c_str());
  add("start", withDefault(features.start), "where in the trajectory to begin [s]");
  add("duration", withDefault(features.duration), "[s]");
  add("seeds", withDefault(1), "how many flights");
  add("first-seed", withDefault<std::uint64_t>(1), "of the first flight; the next has the next");
  add("json", withDefault<std::string>(""), "file to write all figures to");
  add("keep-every", withDefault<std::size_t>(1), "of so many poses one is judged");
  add("events", po::bool_switch(), "print the estimator's events");
}

void addSensorOptions(po::options_description* options) {
  const sim::FeatureSimulatorOptions features;
  auto add = options->add_options();
  add("imu-noise", withDefault<std::string>("euroc"), "euroc, low (a tenth of it) or none");
  add("imu-rate", withDefault(200.0), "[Hz]");
  add("vibration", withDefault(0.0), "at 90 Hz, root mean square [m/s^2]");
  add("td", withDefault(0.0), "true t_imu - t_cam [s]");
  add("rate", withDefault(features.image_rate), "frames per second");
  add("readout", withDefault(features.readout), "of a rolling shutter [s]");
  add("pixel-noise", withDefault(features.pixel_noise), "[px]");
  add("features", withDefault(features.max_features), "tracks per frame");
  add("loss", withDefault(features.loss_probability), "of a track, per frame");
  add("outliers", withDefault(features.outlier_ratio), "share of observations");
  add("moving", withDefault(features.moving_fraction), "share of landmarks that swing");
  add("blackout", po::value<Texts>()->composing()->default_value({}, ""),
      "START:DURATION [s] without features; repeatable");
  add("imu-gap", po::value<Texts>()->composing()->default_value({}, ""),
      "START:DURATION [s] without IMU samples");
}

void addEstimatorOptions(po::options_description* options) {
  const vins::estimator::EstimatorOptions estimator;
  auto add = options->add_options();
  add("window-size", withDefault(estimator.window_size), "keyframes");
  add("keyframe-parallax", withDefault(estimator.keyframe_parallax), "[px]");
  add("max-num-iterations", withDefault(estimator.max_num_iterations), "of a window's solution");
  add("min-tracks", withDefault(estimator.min_tracks), "fewer count as lost");
  add("no-first-estimates", po::bool_switch(), "Jacobians at the current values throughout");
  add("assumed-td", withDefault(0.0), "td that the estimator is told [s]");
  add("assumed-readout", withDefault(0.0), "read-out that the estimator is told [s]");
  add("estimate-td", po::bool_switch(), "that is a guess");
  add("estimate-extrinsic", withDefault(0),
      "0: the camera's pose is known, 1: guessed, 2: unknown");
  add("rotation-error", withDefault(0.0), "of the guess, about an oblique axis [degrees]");
  add("translation-error", withDefault(0.0), "of the guess [m]");
  add("motion-only", withDefault(0), "motion_only_ba: 0 never, 1 with all frames but keyframes");
}

po::options_description describeOptions() {
  po::options_description options;
  addFlightOptions(&options);
  addSensorOptions(&options);
  addEstimatorOptions(&options);
  return options;
}

sim::OdometryStudyOptions readOptions(const po::variables_map& values) {
  sim::OdometryStudyOptions options;
  options.trajectory = values["trajectory"].as<std::string>();
  options.imu_noise = values["imu-noise"].as<std::string>();
  options.imu_rate = values["imu-rate"].as<double>();
  options.vibration = values["vibration"].as<double>();
  options.time_offset = values["td"].as<double>();
  options.features.start = values["start"].as<double>();
  options.features.duration = values["duration"].as<double>();
  options.features.image_rate = values["rate"].as<double>();
  options.features.readout = values["readout"].as<double>();
  options.features.pixel_noise = values["pixel-noise"].as<double>();
  options.features.max_features = values["features"].as<int>();
  options.features.loss_probability = values["loss"].as<double>();
  options.features.outlier_ratio = values["outliers"].as<double>();
  options.features.moving_fraction = values["moving"].as<double>();
  options.keep_every = values["keep-every"].as<std::size_t>();
  options.blackouts = sim::parseIntervals("--blackout", values["blackout"].as<Texts>());
  options.imu_faults.gaps = sim::parseIntervals("--imu-gap", values["imu-gap"].as<Texts>());
  options.estimator.window_size = values["window-size"].as<int>();
  options.estimator.keyframe_parallax = values["keyframe-parallax"].as<double>();
  options.estimator.max_num_iterations = values["max-num-iterations"].as<int>();
  options.estimator.min_tracks = values["min-tracks"].as<int>();
  options.estimator.first_estimates = !values["no-first-estimates"].as<bool>();
  options.estimator.td = values["assumed-td"].as<double>();
  options.estimator.rolling_shutter_readout = values["assumed-readout"].as<double>();
  options.estimator.estimate_td = values["estimate-td"].as<bool>();
  options.estimator.extrinsic =
      static_cast<vins::estimator::ExtrinsicMode>(values["estimate-extrinsic"].as<int>());
  options.estimator.motion_only =
      static_cast<vins::estimator::MotionOnly>(values["motion-only"].as<int>());
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -1.0, 1.0).normalized();
  const double degree = M_PI / 180.0;
  options.estimator.T_bc.rotation =
      options.T_bc.rotation * vins::so3::exp(degree * values["rotation-error"].as<double>() * axis);
  options.estimator.T_bc.position += values["translation-error"].as<double>() * axis;
  options.validate();
  return options;
}

void printMemory(const sim::OdometryRun& run) {
  std::cout << "memory after each minute [MB]:" << std::fixed << std::setprecision(1);
  for (const double megabytes : run.megabytes) std::cout << " " << megabytes;
  std::cout << std::defaultfloat << "\n";
}

/// Flies all seeds.
vins::ToolExit study(const po::variables_map& values) {
  const sim::OdometryStudyOptions options = readOptions(values);
  const auto seeds = static_cast<std::size_t>(std::max(0, values["seeds"].as<int>()));
  const auto first = values["first-seed"].as<std::uint64_t>();
  auto bar = vins::ProgressBar::onStandardError("flying", seeds);
  std::vector<sim::OdometryFigures> figures;
  bool all_initialised = true;
  for (std::size_t i = 0; i < seeds; ++i) {
    const sim::OdometryRun run = sim::runOdometry(options, first + i);
    if (values["events"].as<bool>()) {
      for (const vins::Event& event : run.events) std::cout << event << "\n";
    }
    if (!run.megabytes.empty()) printMemory(run);
    figures.push_back(sim::evaluate(run));
    all_initialised = all_initialised && figures.back().initialised;
    bar.update(i + 1);
  }
  bar.finish();
  sim::printTable(std::cout, figures);
  const std::string json = values["json"].as<std::string>();
  if (!json.empty()) vins::writeTextFile(json, sim::toJson(figures));
  return all_initialised ? vins::ToolExit::kDone : vins::ToolExit::kFellShort;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "simulate_odometry",
      "Follows simulated flights with the estimator, at the level of features.\n"
      "Example: simulate_odometry --trajectory fast --seeds 20 --json fast.json\n"
      "Exit code: 0 all initialised, 2 some did not, 1 bad input.\n",
      describeOptions()};
  return vins::runTool(argc, argv, tool, study);
}
