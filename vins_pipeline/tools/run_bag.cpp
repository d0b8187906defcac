// Visual-inertial odometry and loop closing on a recording: a bag or an ASL folder in, trajectories
// and figures out.

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/core.hpp>

#include "recording_options.h"
#include "run_maps.h"
#include "support_files.h"
#include "track_picture.h"
#include "trajectory_report.h"
#include "vins_core/folder.h"
#include "vins_core/input_error.h"
#include "vins_core/interrupt.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"
#include "vins_core/trajectory_file.h"
#include "vins_pipeline/bag_recording.h"
#include "vins_pipeline/frame_record.h"
#include "vins_pipeline/input_account.h"
#include "vins_pipeline/loop_results.h"
#include "vins_pipeline/pipeline.h"
#include "vins_pipeline/run_record.h"
#include "vins_pipeline/run_results.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;

namespace {

/// A run in the making.
struct Run {
  vins::pipeline::PipelineOptions options;
  std::unique_ptr<vins::pipeline::Recording> recording;
  vins::pipeline::RunRecord record;
  vins::pipeline::RunResults results;
  vins::pipeline::FrameRecord frames;
  vins::pipeline::InputAccount inputs;
  vins::pipeline::TrackPicture picture;
  vins::pipeline::LoopResults loop_results;
  std::vector<vins::pose_graph::SequencePath> paths;  ///< at the end
  std::optional<vins::pose_graph::PoseGraphStatistics>
      graph;  ///< at the end; nothing without loop closing
  vins::pipeline::RunMaps maps;
  vins::Stamp reached = 0;  ///< the latest arrival of all messages used [ns]
  bool interrupted = false;
};

vins::pipeline::RecordingSelection selectionOf(const po::variables_map& values,
                                               const vins::pipeline::PipelineOptions& options) {
  vins::pipeline::RecordingSelection selection;
  selection.imu_topic = options.imu_topic;
  selection.accel_topic = options.accel_topic;
  selection.image_topics = options.image_topics;
  selection.start = values["start"].as<double>();
  if (values.count("duration") > 0) selection.duration = values["duration"].as<double>();
  return selection;
}

vins::pipeline::PipelineOptions readConfig(const po::variables_map& values) {
  std::vector<std::string> warnings;
  vins::pipeline::PipelineOptions options = vins::pipeline::readOptionsForRecording(
      values["config"].as<std::string>(), values["bag"].as<std::vector<std::string>>(), &warnings);
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << "\n";
  // The result must not depend on the computer's speed.
  options.estimator.max_solver_time = 0.0;
  vins::pose_graph::PoseGraphConfiguration& loops = options.loops;
  loops.options.threaded = false;
  const std::string load = values["load-map"].as<std::string>();
  if (!load.empty()) options.map = load;
  if (values["no-loop"].as<bool>()) {
    loops.is_on = false;
    if (load.empty()) options.map.clear();
  }
  if (loops.is_on) {
    const std::string shipped =
        loops.files.needsShipped() ? vins::pipeline::findSupportFiles() : "";
    options.places = vins::pose_graph::readPlaceModel(loops.files, shipped);
  }
  return options;
}

void requireImageSize(const cv::Mat& image, const Run& run) {
  const vins::camera_model::ImageSize size = run.options.cameras[0]->imageSize();
  if (image.cols == size.width && image.rows == size.height) return;
  throw vins::InputError(run.recording->summary().name + ": found images of " +
                         std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                         "; allowed by the configuration's camera: " + std::to_string(size.width) +
                         "x" + std::to_string(size.height));
}

/// An image that cannot be used costs that image only.
void feedImage(const vins::pipeline::RecordedImage& image, vins::pipeline::Pipeline* pipeline,
               Run* run) {
  try {
    const vins::pipeline::StopWatch watch;
    const cv::Mat pixels = image.load();
    run->record.addDuration("read", watch.elapsed());
    requireImageSize(pixels, *run);
    run->inputs.addImage(image.stamp);
    pipeline->addImage(image.stamp, pixels);
  } catch (const vins::InputError& error) {
    const vins::Event event = run->inputs.refuse(image.stamp, error.what());
    run->record.addEvents({event});
    run->results.add(event);
  }
}

void feed(const vins::pipeline::Record& message, vins::pipeline::Pipeline* pipeline, Run* run) {
  using vins::pipeline::RecordedAcceleration;
  if (const auto* sample = std::get_if<vins::ImuSample>(&message.data)) {
    run->inputs.addImu(sample->stamp);
    pipeline->addImu(*sample);
  } else if (const auto* truth = std::get_if<vins::pipeline::RecordedTruth>(&message.data)) {
    run->results.add(*truth);
  } else if (const auto* reading = std::get_if<RecordedAcceleration>(&message.data)) {
    run->inputs.addAcceleration(reading->stamp);
    pipeline->addAcceleration(reading->stamp, reading->acceleration);
  } else {
    feedImage(std::get<vins::pipeline::RecordedImage>(message.data), pipeline, run);
  }
}

void work(vins::pipeline::Pipeline* pipeline, Run* run) {
  while (const auto result = pipeline->process()) {
    run->record.addFrame(result->durations);
    run->record.addEvents(result->events);
    run->inputs.addEvents(result->events);
    run->results.add(*result);
    run->frames.add(*result);
    run->picture.add(*result, *run->options.cameras.front());
    run->loop_results.add(*result);
  }
  const std::vector<vins::Event> findings = pipeline->takeInputEvents();
  run->record.addEvents(findings);
  run->inputs.addEvents(findings);
  for (const vins::Event& event : findings) {
    run->results.add(event);
    std::cerr << event << "\n";
  }
}

void closeGraph(vins::pipeline::Pipeline* pipeline, Run* run) {
  vins::pose_graph::PoseGraph* graph = pipeline->poseGraph();
  if (graph == nullptr) return;
  const vins::pipeline::StopWatch watch;
  graph->finish();
  run->record.addDuration("pose_graph/finish", watch.elapsed());
  run->paths = graph->paths();
  run->graph = graph->statistics();
  finishMaps(pipeline, &run->maps);
}

std::string noteOf(const Run& run) {
  const double seconds = vins::toSeconds(run.reached - run.recording->summary().begin);
  std::ostringstream note;
  note << std::fixed << std::setprecision(1) << seconds << " s, "
       << seconds / std::max(run.record.elapsed().wall, 1e-9) << "x real time, "
       << run.results.state();
  return note.str();
}

void process(vins::Interrupt* interrupt, Run* run) {
  constexpr vins::Stamp kMillisecond = 1'000'000;
  const vins::pipeline::RecordingSummary& summary = run->recording->summary();
  const auto shareOf = [&](vins::Stamp arrival) {
    return static_cast<std::size_t>(std::max<vins::Stamp>(0, arrival - summary.begin) /
                                    kMillisecond);
  };
  vins::pipeline::Pipeline pipeline(run->options);
  auto bar = vins::ProgressBar::onStandardError("odometry", shareOf(summary.end));
  while (const auto message = run->recording->next()) {
    run->interrupted = interrupt->isRequested();
    if (run->interrupted) break;
    run->reached = std::max(run->reached, message->arrival);
    feed(*message, &pipeline, run);
    work(&pipeline, run);
    bar.update(shareOf(run->reached), noteOf(*run));
  }
  if (!run->interrupted) {
    pipeline.finish();
    work(&pipeline, run);
    run->inputs.requireImages();
  }
  closeGraph(&pipeline, run);
  bar.finish(noteOf(*run));
}

double secondsDone(const Run& run) {
  return vins::toSeconds(run.reached - run.recording->summary().begin);
}

/// The ground truth as a file that covers this run, or as it was given; "" where there is none.
std::string prepareTruth(const std::string& given, const fs::path& folder, const Run& run) {
  const std::string path = (folder / "ground_truth.txt").string();
  std::string text = run.results.groundTruth();
  if (!given.empty()) {
    if (!fs::is_regular_file(given)) return given;
    text.clear();
    const auto& summary = run.recording->summary();
    const vins::Trajectory truth = vins::readTrajectoryFile(given);
    for (const vins::StampedPose& pose : truth.poses()) {
      const bool is_inside = pose.stamp >= summary.begin && pose.stamp <= run.reached;
      if (is_inside) text += vins::toTumLine(pose) + "\n";
    }
    if (text.empty()) {
      throw vins::InputError(given + ": has no pose in the time of the recording, from " +
                             std::to_string(summary.begin) + " to " + std::to_string(run.reached) +
                             " ns");
    }
  }
  if (text.empty()) return "";
  vins::writeTextFile(path, text);
  return path;
}

void writeFiles(const fs::path& folder, const Run& run) {
  const auto write = [&](const char* name, const std::string& text) {
    vins::writeTextFile((folder / name).string(), text);
  };
  write("vio_live.txt", run.results.vioLive());
  write("vins_result_no_loop.csv", run.results.vinsMonoCsv());
  if (run.graph) {
    write("loop_live.txt", run.loop_results.live());
    write("loop_final.txt", run.loop_results.finalPath(run.paths));
    write("vins_result_loop.csv", vins::pipeline::LoopResults::vinsMonoCsv(run.paths));
  }
  write("timing.json", run.record.timingJson(secondsDone(run)));
  write("events.csv", run.record.eventsCsv());
  write("tracker.csv", run.frames.trackerCsv());
  write("estimator.csv", run.frames.estimatorCsv());
  run.picture.write((folder / "tracks.png").string());
}

void printWarnings(const vins::pipeline::RunResults& results) {
  if (results.warnings().empty()) return;
  std::cout << "warnings      ";
  const char* separator = "";
  for (const auto& [code, count] : results.warnings()) {
    std::cout << separator << code << " " << count;
    separator = ", ";
  }
  std::cout << " (see events.csv)\n";
}

void printLoops(const vins::pose_graph::PoseGraphStatistics& graph) {
  std::cout << "loops         " << graph.found << " found, " << graph.refined
            << " of them refined in the window; " << graph.describeRejected() << "\n"
            << "pose graph    " << graph.keyframes << " keyframes, " << graph.skipped
            << " left out, " << graph.sequences << " sequences, " << graph.optimizations
            << " optimizations, " << 1e-6 * static_cast<double>(graph.memory) << " MB\n";
}

void printSummary(const Run& run, const fs::path& folder) {
  const vins::pipeline::RecordingSummary& summary = run.recording->summary();
  const vins::pipeline::RunResults& results = run.results;
  const double wall = run.record.elapsed().wall;
  std::cout << std::fixed << std::setprecision(2) << "recording     " << summary.name << ": "
            << summary.duration() << " s, " << summary.images << " images, " << summary.imu_samples
            << " IMU samples\n";
  std::cout << run.inputs.problems(summary);
  if (results.initialisedAfter()) {
    std::cout << "initialised   " << *results.initialisedAfter() << " s after the first image\n";
  } else {
    std::cout << "initialised   never\n" << run.inputs.waitingReasons();
  }
  std::cout << "odometry      " << results.odometries() << " of " << summary.images
            << " images, path " << results.pathLength() << " m, " << results.resets() << " resets, "
            << (results.isTracking() ? "tracking" : "not tracking")
            << (run.interrupted ? " when interrupted\n" : " at the end\n");
  if (!results.rig().empty()) std::cout << "rig, as estimated\n" << results.rig();
  if (run.graph) printLoops(*run.graph);
  std::cout << run.maps;
  printWarnings(results);
  std::cout << "speed         " << secondsDone(run) << " s in " << wall
            << " s: " << secondsDone(run) / std::max(wall, 1e-9) << "x real time, peak memory "
            << vins::pipeline::peakMemoryMb() << " MB\n"
            << "written to    " << folder.string() << ": vio_live.txt, vins_result_no_loop.csv, "
            << (run.graph ? "loop_live.txt, loop_final.txt, vins_result_loop.csv, " : "")
            << "timing.json, events.csv, tracker.csv, estimator.csv"
            << (run.picture.isDrawn() ? ", tracks.png\n\n" : "\n\n") << run.record.timingTable();
}

void report(const po::variables_map& values, const fs::path& folder, const Run& run) {
  const std::string truth = prepareTruth(values["ground-truth"].as<std::string>(), folder, run);
  if (truth.empty() || run.results.odometries() == 0) return;
  std::cout << "\n";
  std::vector<std::string> estimates = {
      vins::pipeline::atImuTime(folder / "vio_live.txt", run.results)};
  if (run.graph) {
    estimates.push_back(vins::pipeline::atImuTime(folder / "loop_live.txt", run.results));
    estimates.push_back(vins::pipeline::atImuTime(folder / "loop_final.txt", run.results));
  }
  const bool is_made = vins::pipeline::makeReport(
      {truth, estimates, values["align"].as<std::string>(), (folder / "report.html").string(),
       (folder / "evaluation.json").string()});
  if (is_made) std::cout << "report        " << (folder / "report.html").string() << "\n";
}

vins::ToolExit runBag(const po::variables_map& values) {
  vins::pipeline::requireAlignment(values["align"].as<std::string>());
  // One thread: the same bytes everywhere, and the CPU time of the work itself.
  cv::setNumThreads(1);
  Run run;
  run.options = readConfig(values);
  if (!run.options.map.empty() && !fs::is_regular_file(run.options.map)) {
    throw vins::InputError(run.options.map + ": is no map file");
  }
  run.maps.file_to_save = values["save-map"].as<std::string>();
  if (!run.maps.file_to_save.empty() && !run.options.loops.is_on) {
    throw vins::InputError("--save-map: a map needs loop closing, which is off");
  }
  run.recording = vins::pipeline::openRecording(values["bag"].as<std::vector<std::string>>(),
                                                selectionOf(values, run.options));
  run.reached = run.recording->summary().begin;
  if (values.count("draw-tracks") > 0) {
    const double after = values["draw-tracks"].as<double>();
    run.picture = vins::pipeline::TrackPicture(run.reached + vins::toNanoseconds(after));
  }
  const fs::path folder = values["out"].as<std::string>();
  vins::makeFolder(folder.string());
  {
    // Until the files are written, nothing ends the program half-way.
    vins::Interrupt interrupt;
    process(&interrupt, &run);
    writeFiles(folder, run);
  }
  printSummary(run, folder);
  if (!std::cout.flush()) throw vins::InputError("standard output: cannot be written");
  if (run.interrupted) return vins::ToolExit::kInterrupted;
  report(values, folder, run);
  if (!run.maps.error.empty()) throw vins::InputError(run.maps.error);
  const bool is_tracking = run.results.odometries() > 0 && run.results.isTracking();
  const bool is_whole = run.recording->summary().damage.empty() && !run.inputs.imuEnd();
  return is_tracking && is_whole ? vins::ToolExit::kDone : vins::ToolExit::kFellShort;
}

po::options_description describeOptions() {
  po::options_description options;
  auto add = options.add_options();
  add("config", po::value<std::string>()->required(),
      "configuration of the rig, in VINS-Mono's form");
  add("bag", po::value<std::vector<std::string>>()->required(),
      "a ROS bag, the bags of a recording that was split, or a folder in the ASL layout");
  add("out", po::value<std::string>()->default_value("run_bag_output"),
      "folder to write to; it is made");
  add("start", po::value<double>()->default_value(0.0), "how much to skip at the start [s]");
  add("duration", po::value<double>(), "[s]; to the end if not given");
  add("ground-truth", po::value<std::string>()->default_value(""),
      "poses to compare with (TUM, EuRoC csv, ASL folder, FILE.bag:/topic); if not given, those "
      "of the recording");
  add("align", po::value<std::string>()->default_value("posyaw"),
      "for the comparison: none, posyaw, se3, sim3");
  add("load-map", po::value<std::string>()->default_value(""),
      "a map to relocalise in; if not given, what the configuration says "
      "(load_previous_pose_graph)");
  add("save-map", po::value<std::string>()->default_value(""),
      "where the map is saved in the end, the loaded one's part included");
  add("no-loop", po::bool_switch(), "odometry only, without loop closure");
  add("draw-tracks", po::value<double>(),
      "draw the image this long after the recording's start, with its tracks: tracks.png [s]");
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "run_bag",
      "Visual-inertial odometry and loop closing on a recording, as fast as the machine allows.\n"
      "Nothing is dropped, and the same recording gives the same bytes.\n"
      "Usage: run_bag CONFIG BAG ... [options]\n"
      "Example: run_bag config/euroc/euroc_config.yaml MH_01_easy.bag --out mh01\n"
      "         run_bag rig.yaml walk_*.bag     (rosbag record --split; walk.bag.active, too)\n",
      describeOptions(),
      {{"config", 1}, {"bag", -1}},
      "Written to the folder: vio_live.txt (TUM, each pose as it was known at its\n"
      "frame), loop_live.txt (corrected by the loops known then), loop_final.txt (by all\n"
      "loops), vins_result_no_loop.csv and vins_result_loop.csv (VINS-Mono's form),\n"
      "timing.json, events.csv, of each frame what the tracker and the estimator had\n"
      "(tracker.csv, estimator.csv: tracks, landmarks, standard deviations) and, with\n"
      "ground truth, ground_truth.txt, report.html, evaluation.json.\n"
      "Exit code: 0 initialised and tracking to the end, 1 bad input or no room for a file,\n"
      "2 never initialised, lost at the end, IMU ended before the images or a damaged bag, 130 "
      "interrupted (what was done so far is\n"
      "written).\n"};
  return vins::runTool(argc, argv, tool, runBag);
}
