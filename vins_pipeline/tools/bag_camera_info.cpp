#include <algorithm>
#include <filesystem>

#include <sensor_msgs/CameraInfo.h>

#include "bag_file.h"
#include "bag_topics.h"
#include "recorded_message.h"
#include "vins_core/input_error.h"
#include "vins_msgs/camera_info.h"
#include "vins_pipeline/bag_recording.h"

namespace vins::pipeline {
namespace {

/// The camera of the first message on the topic that can be read; null where there is none.
std::unique_ptr<camera_model::Camera> firstCamera(BagFile* file, const std::string& topic) {
  for (const BagMessage& message : file->takeMessages()) {
    const BagConnection& connection = file->connections().at(message.connection);
    if (connection.topic != topic) continue;
    const std::string place = file->path() + ": " + topic;
    requireTopic(file->path(), {{topic, connection.type}}, topic, {kCameraInfo});
    if (connection.md5sum != definitionOf(kCameraInfo)) {
      throw InputError(place + ": messages are of another definition than " + kCameraInfo);
    }
    return vins_msgs::cameraOf(readMessage<sensor_msgs::CameraInfo>(file->read(message)), place);
  }
  return nullptr;
}

void requireBag(const std::string& path, const std::string& topic) {
  if (std::filesystem::is_regular_file(path)) return;
  throw InputError(path + ": is no bag, which camera_info_topic '" + topic +
                   "' needs; allowed: the intrinsics in the file (model_type, ...)");
}

}  // namespace

std::unique_ptr<camera_model::Camera> readCameraInfo(const std::vector<std::string>& paths,
                                                     const std::string& topic) {
  const std::string recorded = topic.rfind('/', 0) == 0 ? topic : "/" + topic;
  TopicTypes types;
  for (const std::string& path : paths) {
    requireBag(path, topic);
    BagFile file(path);
    for (const auto& [id, connection] : file.connections()) {
      types[connection.topic] = connection.type;
    }
    if (auto camera = firstCamera(&file, recorded)) return camera;
  }
  const std::string name = paths.empty() ? "recording" : paths.front();
  requireTopic(name, types, recorded, {kCameraInfo});
  throw InputError(name + ": has no message that can be read on " + recorded);
}

}  // namespace vins::pipeline
