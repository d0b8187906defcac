// Converts a recording in the ASL layout, in which EuRoC is distributed, to a ROS bag.

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "vins_core/input_error.h"
#include "vins_core/interrupt.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"
#include "vins_pipeline/asl_folder.h"
#include "vins_pipeline/bag_writer.h"
#include "vins_pipeline/message_schedule.h"

namespace po = boost::program_options;

namespace {

/// The streams of a bag; at equal times their messages come in this order.
enum Stream : std::size_t { kImu, kGroundTruth, kCamera0, kCamera1 };

std::vector<vins::pipeline::ScheduledMessage> scheduleOf(
    const vins::pipeline::AslRecording& recording) {
  std::vector<std::vector<vins::Stamp>> arrivals(4);
  for (const auto& sample : recording.imu) arrivals[kImu].push_back(sample.stamp);
  for (const auto& pose : recording.ground_truth.poses()) {
    arrivals[kGroundTruth].push_back(pose.stamp);
  }
  for (std::size_t camera = 0; camera < recording.cameras.size(); ++camera) {
    for (const auto& image : recording.cameras[camera]) {
      arrivals[kCamera0 + camera].push_back(image.stamp);
    }
  }
  return vins::pipeline::inOrderOfArrival(arrivals);
}

cv::Mat readImage(const std::string& path) {
  cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw vins::InputError(path + ": is no image that can be read");
  return image;
}

void write(const vins::pipeline::AslRecording& recording,
           const vins::pipeline::ScheduledMessage& message, vins::pipeline::BagWriter* bag) {
  if (message.stream == kImu) {
    bag->writeImu(message.arrival, recording.imu[message.index]);
  } else if (message.stream == kGroundTruth) {
    const vins::StampedPose& pose = recording.ground_truth.poses()[message.index];
    bag->writeGroundTruth(message.arrival, pose.stamp, pose.T_wb);
  } else {
    const std::size_t camera = message.stream - kCamera0;
    const vins::pipeline::ImageFile& image = recording.cameras[camera][message.index];
    bag->writeImage(camera == 0 ? vins::pipeline::topic::kCamera0 : vins::pipeline::topic::kCamera1,
                    message.arrival, image.stamp, readImage(image.path));
  }
}

void describe(const vins::pipeline::AslRecording& recording) {
  std::cout << recording.folder << ": ";
  for (std::size_t camera = 0; camera < recording.cameras.size(); ++camera) {
    std::cout << recording.cameras[camera].size() << " images of cam" << camera << ", ";
  }
  std::cout << recording.imu.size() << " IMU samples, ";
  if (recording.ground_truth.empty()) {
    std::cout << "no ground truth\n";
  } else {
    std::cout << recording.ground_truth.poses().size() << " poses of "
              << recording.ground_truth_source << "\n";
  }
  for (const std::string& path : recording.missing_images) {
    std::cerr << "skipped: " << path << " is missing\n";
  }
}

vins::ToolExit convert(const po::variables_map& values) {
  const std::string bag_path = values["bag"].as<std::string>();
  const vins::pipeline::AslRecording recording = vins::pipeline::readAslFolder(
      values["folder"].as<std::string>(), values["skip-missing-images"].as<bool>()
                                              ? vins::pipeline::MissingImages::kSkip
                                              : vins::pipeline::MissingImages::kRefuse);
  describe(recording);
  const auto messages = scheduleOf(recording);
  vins::Interrupt interrupt;
  vins::pipeline::BagWriter bag(bag_path);
  auto bar = vins::ProgressBar::onStandardError("writing " + bag_path, messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (interrupt.isRequested()) {
      std::cerr << "\nasl_to_bag: interrupted; " << bag_path << " was not written\n";
      return vins::ToolExit::kInterrupted;
    }
    write(recording, messages[i], &bag);
    bar.update(i + 1);
  }
  bag.finish();
  bar.finish();
  const auto megabytes = static_cast<double>(std::filesystem::file_size(bag_path)) / 1e6;
  std::cout << "written: " << bag_path << ", " << messages.size() << " messages, " << megabytes
            << " MB\n";
  return vins::ToolExit::kDone;
}

po::options_description describeOptions() {
  po::options_description options;
  options.add_options()("folder", po::value<std::string>()->required(),
                        "folder of the recording: its mav0, the one above, or the one above that")(
      "bag", po::value<std::string>()->required(), "bag to write")(
      "skip-missing-images", po::bool_switch(),
      "leave out images that are listed but not there, instead of refusing");
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "asl_to_bag",
      "Converts a recording in the ASL layout (EuRoC as it is distributed) to a ROS bag\n"
      "with the topics /cam0/image_raw, /cam1/image_raw, /imu0, /ground_truth/pose.\n"
      "Usage: asl_to_bag FOLDER OUT.bag\n"
      "Example: asl_to_bag MH_01_easy MH_01_easy.bag\n",
      describeOptions(),
      {{"folder", 1}, {"bag", 1}}};
  return vins::runTool(argc, argv, tool, convert);
}
