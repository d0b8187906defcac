// Counts the tracks of recordings: the project's front end beside the textbook's.

#include <deque>
#include <iomanip>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/core.hpp>

#include "feature_tracker/feature_tracker.h"
#include "feature_tracker/gyroscope_buffer.h"
#include "simulation/gftt_tracker.h"
#include "simulation/track_account.h"
#include "vins_core/run_tool.h"
#include "vins_pipeline/bag_recording.h"
#include "vins_pipeline/pipeline.h"

namespace po = boost::program_options;

namespace {

using vins::pipeline::RecordedImage;
using vins::simulation::TrackAccount;

po::options_description describeOptions() {
  po::options_description options;
  auto add = options.add_options();
  add("config", po::value<std::string>()->required(), "configuration of the rig");
  add("recording", po::value<std::vector<std::string>>()->required(),
      "bag, bags of one recording, or ASL folder");
  add("start", po::value<double>()->default_value(0.0), "how much to skip at the start [s]");
  add("duration", po::value<double>(), "[s]; to the end where it is not given");
  add("split", po::value<std::vector<double>>()->multitoken()->default_value({}, ""),
      "where the spans begin that are told apart, after the first [s]");
  add("quality", po::value<double>()->default_value(0.01), "of goodFeaturesToTrack");
  return options;
}

/// Both front ends on the same images.
class Comparison {
 public:
  Comparison(const vins::pipeline::PipelineOptions& options, double quality)
      : tracker_(options.cameras, {options.estimator.T_bc}, options.tracker, options.mask),
        gyroscope_(options.estimator.td),
        gftt_({options.tracker.max_features, options.tracker.min_distance, quality}) {}

  /// An image waits until the samples up to its time have come.
  void add(const vins::pipeline::Record& record) {
    if (const auto* sample = std::get_if<vins::ImuSample>(&record.data)) gyroscope_.add(*sample);
    if (const auto* image = std::get_if<RecordedImage>(&record.data)) images_.push_back(*image);
    while (!images_.empty() && gyroscope_.reaches(images_.front().stamp)) trackNext();
  }

  /// The recording has ended: no image waits any longer.
  void finish() {
    while (!images_.empty()) trackNext();
  }

  TrackAccount own, textbook;

 private:
  void trackNext() {
    const RecordedImage recorded = images_.front();
    images_.pop_front();
    const vins::Stamp stamp = recorded.stamp;
    if (!first_) first_ = stamp;
    const cv::Mat image = recorded.load();
    const auto result = tracker_.track({image}, stamp, gyroscope_.takeUntil(stamp));
    if (!result.frame) return;
    const double time = vins::toSeconds(stamp - *first_);
    std::vector<std::int64_t> ids;
    for (const auto& observation : result.frame->observations) ids.push_back(observation.id);
    own.add(time, ids);
    gftt_.add(image);
    ids.clear();
    for (const auto& track : gftt_.tracks()) ids.push_back(track.id);
    textbook.add(time, ids);
  }

  vins::feature_tracker::FeatureTracker tracker_;
  vins::feature_tracker::GyroscopeBuffer gyroscope_;
  vins::simulation::GfttTracker gftt_;
  std::deque<RecordedImage> images_;
  std::optional<vins::Stamp> first_;
};

void printSpan(double begin, double end, const Comparison& comparison) {
  const auto row = [&](const char* name, const TrackAccount& account) {
    const vins::simulation::TrackFigures figures = account.figures(begin, end);
    if (figures.images == 0) return;
    std::cout << std::fixed << std::setprecision(1) << std::setw(6) << begin << "  " << std::left
              << std::setw(14) << name << std::right << std::setw(6) << figures.images
              << std::setw(9) << figures.tracks << std::setw(11) << figures.followed << std::setw(8)
              << figures.life << std::setw(8) << figures.age << "\n";
  };
  row("this project", comparison.own);
  row("GFTT + KLT", comparison.textbook);
}

vins::pipeline::RecordingSelection selectionOf(const po::variables_map& values,
                                               const vins::pipeline::PipelineOptions& options) {
  vins::pipeline::RecordingSelection selection;
  selection.imu_topic = options.imu_topic;
  selection.image_topics = options.image_topics;
  selection.start = values["start"].as<double>();
  if (values.count("duration") > 0) selection.duration = values["duration"].as<double>();
  return selection;
}

vins::ToolExit measure(const po::variables_map& values) {
  cv::setNumThreads(1);
  const auto options =
      vins::pipeline::readPipelineOptions(values["config"].as<std::string>(), nullptr);
  const auto recording = vins::pipeline::openRecording(
      values["recording"].as<std::vector<std::string>>(), selectionOf(values, options));
  Comparison comparison(options, values["quality"].as<double>());
  while (const auto record = recording->next()) comparison.add(*record);
  comparison.finish();
  std::cout << "from [s] front end    images   tracks   followed    life     age\n";
  std::vector<double> begins = values["split"].as<std::vector<double>>();
  begins.insert(begins.begin(), 0.0);
  begins.push_back(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    printSpan(begins[i], begins[i + 1], comparison);
  }
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "measure_tracks",
      "Counts the tracks of a recording, and how long they live: those of this project beside\n"
      "those of cv::goodFeaturesToTrack and pyramidal Lucas-Kanade, for as many corners and the\n"
      "same distance between them.\n"
      "Usage: measure_tracks CONFIG RECORDING [--split 10 25]\n",
      describeOptions(),
      {{"config", 1}, {"recording", -1}}};
  return vins::runTool(argc, argv, tool, measure);
}
