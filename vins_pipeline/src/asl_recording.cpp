#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "vins_core/input_error.h"
#include "vins_pipeline/asl_folder.h"
#include "vins_pipeline/message_schedule.h"
#include "vins_pipeline/recording.h"

namespace vins::pipeline {
namespace {

/// At equal times messages come in this order, then the cameras.
enum Stream : std::size_t { kImu, kTruth, kCamera };

/// The number behind "cam" in the topic's name, or `otherwise`.
std::size_t cameraOfTopic(const std::string& topic, std::size_t otherwise) {
  const std::size_t place = topic.find("cam");
  if (place == std::string::npos || place + 3 >= topic.size()) return otherwise;
  const char digit = topic[place + 3];
  return std::isdigit(static_cast<unsigned char>(digit)) ? static_cast<std::size_t>(digit - '0')
                                                         : otherwise;
}

cv::Mat readGrey(const std::string& path) {
  cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError(path + ": is no image that can be read");
  return image;
}

class AslFolderRecording : public Recording {
 public:
  AslFolderRecording(const std::string& folder, const RecordingSelection& selection)
      : folder_(readAslFolder(folder, MissingImages::kSkip)) {
    chooseCameras(selection);
    schedule();
    cutTo(selection);
    summarize(folder);
  }

  std::optional<Record> next() override {
    if (next_ == messages_.size()) return std::nullopt;
    const ScheduledMessage& message = messages_[next_++];
    return Record{message.arrival, dataOf(message)};
  }

 private:
  void chooseCameras(const RecordingSelection& selection) {
    for (std::size_t i = 0; i < selection.image_topics.size(); ++i) {
      const std::size_t camera = cameraOfTopic(selection.image_topics[i], i);
      if (camera >= folder_.cameras.size()) {
        throw InputError(folder_.folder + ": has no cam" + std::to_string(camera) + " for topic '" +
                         selection.image_topics[i] + "'; it has " +
                         std::to_string(folder_.cameras.size()) + " cameras, from cam0 on");
      }
      cameras_.push_back(camera);
    }
  }

  void schedule() {
    std::vector<std::vector<Stamp>> arrivals(kCamera + cameras_.size());
    for (const ImuSample& sample : folder_.imu) arrivals[kImu].push_back(sample.stamp);
    for (const StampedPose& pose : folder_.ground_truth.poses()) {
      arrivals[kTruth].push_back(pose.stamp);
    }
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      for (const ImageFile& image : folder_.cameras[cameras_[i]]) {
        arrivals[kCamera + i].push_back(image.stamp);
      }
    }
    messages_ = inOrderOfArrival(arrivals);
  }

  void cutTo(const RecordingSelection& selection) {
    // Ground truth may go on for minutes before and after what was recorded by the rig.
    const auto is_sensor = [](const ScheduledMessage& m) { return m.stream != kTruth; };
    const auto first = std::find_if(messages_.begin(), messages_.end(), is_sensor);
    const auto last = std::find_if(messages_.rbegin(), messages_.rend(), is_sensor);
    if (first == messages_.end()) throw InputError(folder_.folder + ": holds no messages");
    const Stamp begin = first->arrival + toNanoseconds(selection.start);
    const Stamp end =
        selection.duration ? begin + toNanoseconds(*selection.duration) : last->arrival;
    const double length = toSeconds(last->arrival - first->arrival);
    const auto is_outside = [&](const ScheduledMessage& m) {
      return m.arrival < begin || m.arrival > end;
    };
    messages_.erase(std::remove_if(messages_.begin(), messages_.end(), is_outside),
                    messages_.end());
    if (std::none_of(messages_.begin(), messages_.end(), is_sensor)) {
      std::ostringstream message;
      message << folder_.folder << ": nothing from second " << selection.start << " on; it is "
              << length << " s long";
      throw InputError(message.str());
    }
  }

  void summarize(const std::string& name) {
    summary_.name = name;
    summary_.begin = messages_.front().arrival;
    summary_.end = messages_.back().arrival;
    for (const ScheduledMessage& message : messages_) {
      ++(message.stream == kImu     ? summary_.imu_samples
         : message.stream == kTruth ? summary_.truth_poses
                                    : summary_.images);
    }
    if (summary_.truth_poses > 0) {
      summary_.truth_source = folder_.folder + "/" + folder_.ground_truth_source;
    }
  }

  decltype(Record::data) dataOf(const ScheduledMessage& message) {
    if (message.stream == kImu) return folder_.imu[message.index];
    if (message.stream == kTruth) {
      const StampedPose& pose = folder_.ground_truth.poses()[message.index];
      return RecordedTruth{pose.stamp, pose.T_wb, folder_.ground_truth_source != "leica0"};
    }
    const std::size_t camera = message.stream - kCamera;
    const ImageFile& image = folder_.cameras[cameras_[camera]][message.index];
    return RecordedImage{static_cast<int>(camera), image.stamp,
                         [path = image.path] { return readGrey(path); }};
  }

  AslRecording folder_;
  std::vector<std::size_t> cameras_;  ///< of the folder, one per selected topic
  std::vector<ScheduledMessage> messages_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<Recording> openAslRecording(const std::string& folder,
                                            const RecordingSelection& selection) {
  selection.validate();
  return std::make_unique<AslFolderRecording>(folder, selection);
}

}  // namespace vins::pipeline
