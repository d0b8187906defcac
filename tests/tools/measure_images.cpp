// Measures how hard the images of recordings are to track.

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <boost/program_options.hpp>

#include "simulation/image_statistics.h"
#include "vins_core/run_tool.h"
#include "vins_pipeline/bag_recording.h"

namespace po = boost::program_options;

namespace {

using vins::pipeline::Record;
using vins::pipeline::RecordedImage;
using vins::simulation::ImageStatistics;

po::options_description describeOptions() {
  po::options_description options;
  auto add = options.add_options();
  add("recording", po::value<std::vector<std::string>>()->required(), "bags or ASL folders");
  add("topic", po::value<std::string>()->default_value("/cam0/image_raw"), "of the images");
  add("imu-topic", po::value<std::string>()->default_value("/imu0"), "of the IMU");
  add("start", po::value<double>()->default_value(0.0), "[s]");
  add("duration", po::value<double>(), "[s]; to the end where it is not given");
  add("every", po::value<int>()->default_value(5), "statistics of each n-th image");
  return options;
}

vins::pipeline::RecordingSelection selectionOf(const po::variables_map& values) {
  vins::pipeline::RecordingSelection selection;
  selection.imu_topic = values["imu-topic"].as<std::string>();
  selection.image_topics = {values["topic"].as<std::string>()};
  selection.start = values["start"].as<double>();
  if (values.count("duration") > 0) selection.duration = values["duration"].as<double>();
  return selection;
}

/// Prints the statistics, and the quantiles of the number of tracks.
void measure(const std::string& path, const po::variables_map& values) {
  const auto recording = vins::pipeline::openRecording({path}, selectionOf(values));
  vins::simulation::ImageStatisticsMeter meter;
  vins::simulation::TrackCounter counter;
  std::vector<int> tracks;
  for (int count = 0; const auto record = recording->next();) {
    const auto* recorded = std::get_if<RecordedImage>(&record->data);
    if (recorded == nullptr) continue;
    const cv::Mat image = recorded->load();
    if (count % std::max(1, values["every"].as<int>()) == 0) meter.add(image);
    const int kept = counter.add(image);
    if (count++ > 0) tracks.push_back(kept);
  }
  std::sort(tracks.begin(), tracks.end());
  ImageStatistics statistics = meter.result();
  for (const int kept : tracks) statistics.tracks += kept / static_cast<double>(tracks.size());
  std::cout << "recording: " << path << "\n" << statistics;
  if (tracks.empty()) return;
  std::cout << "tracks at 0, 10, 50, 90 %:";
  for (const double share : {0.0, 0.1, 0.5, 0.9}) {
    std::cout << " " << tracks[static_cast<std::size_t>(share * double(tracks.size() - 1))];
  }
  std::cout << "\n" << std::endl;
}

vins::ToolExit measureAll(const po::variables_map& values) {
  for (const auto& path : values["recording"].as<std::vector<std::string>>()) {
    measure(path, values);
  }
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "measure_images",
      "Measures how hard the images of recordings are to track: corners by strength, gradients,\n"
      "blur, noise, and tracks that are kept.\n"
      "Usage: measure_images RECORDING...\n",
      describeOptions(),
      {{"recording", -1}}};
  return vins::runTool(argc, argv, tool, measureAll);
}
