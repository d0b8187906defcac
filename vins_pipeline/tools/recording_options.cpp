#include "recording_options.h"

#include <filesystem>

#include "camera_model/opencv_intrinsics.h"
#include "vins_core/input_error.h"
#include "vins_pipeline/bag_recording.h"

namespace vins::pipeline {
namespace {

/// What camera_info_topic says against the file's camera; empty where they agree.
std::string compareWithCameraInfo(const std::vector<std::string>& recording,
                                  const PipelineOptions& options) {
  const std::string& topic = options.camera_info_topic;
  if (topic.empty()) return "";
  try {
    const auto camera = readCameraInfo(recording, topic);
    return camera_model::describeDifference(*options.cameras.front(), *camera, topic).value_or("");
  } catch (const InputError& error) {
    return error.what();  // the file's camera is enough
  }
}

}  // namespace

PipelineOptions readOptionsForRecording(const std::string& config,
                                        const std::vector<std::string>& recording,
                                        std::vector<std::string>* warnings) {
  PipelineOptions options = readPipelineOptions(
      config, warnings,
      [&recording](const std::string& topic) { return readCameraInfo(recording, topic); });
  const std::string difference = compareWithCameraInfo(recording, options);
  if (!difference.empty()) warnings->push_back(difference);
  if (std::filesystem::is_directory(recording.front())) options.accel_topic.clear();
  return options;
}

}  // namespace vins::pipeline
