#include "vins_pipeline/bag_recording.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "bag_file.h"
#include "bag_topics.h"
#include "recorded_message.h"
#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"
#include "vins_msgs/image_converter.h"
#include "vins_pipeline/stamp_order.h"

namespace vins::pipeline {
namespace {

std::string placeOf(const std::string& bag, const std::string& topic, Stamp stamp) {
  return bag + ": " + topic + ": image at " + std::to_string(stamp) + " ns";
}

std::string nameOf(const std::vector<std::string>& paths) {
  if (paths.size() == 1) return paths.front();
  return paths.front() + " and " + std::to_string(paths.size() - 1) + " more";
}

class BagRecording : public Recording {
 public:
  BagRecording(const std::vector<std::string>& paths, const RecordingSelection& selection)
      : selection_(selection) {
    summary_.name = nameOf(paths);
    for (const std::string& path : paths) files_.emplace_back(path);
    for (const BagFile& file : files_) {
      for (const auto& [id, connection] : file.connections()) {
        types_[connection.topic] = connection.type;
      }
    }
    requireTopics();
    truth_topic_ = truthTopicOf(types_);
    converters_.resize(selection_.image_topics.size());
    for (BagFile& file : files_) addMessages(&file);
    for (BagFile& file : files_) requireDefinitions(file);
    // Files of one recording follow each other in time, whatever the order they are given in.
    std::stable_sort(messages_.begin(), messages_.end(), [](const Place& a, const Place& b) {
      return a.message.arrival < b.message.arrival;
    });
    chooseSpan();
    keepSpan();
    describeEnds();
    for (const Place& place : messages_) {
      order_.add(streamOf(topicOf(place)), place.message.stamp);
    }
    order_.sort();
  }

  std::optional<Record> next() override {
    if (next_ == order_.place().size()) return std::nullopt;
    const Place& place = messages_[order_.place()[next_++]];
    return Record{place.message.arrival, dataOf(place)};
  }

 private:
  using Data = decltype(Record::data);

  /// A message, and the bag that it stands in.
  struct Place {
    BagFile* file = nullptr;
    BagMessage message;
  };

  static const BagConnection& connectionOf(const Place& place) {
    return place.file->connections().at(place.message.connection);
  }
  static const std::string& topicOf(const Place& place) { return connectionOf(place).topic; }

  void requireTopics() {
    requireTopic(summary_.name, types_, selection_.imu_topic, {kImu});
    if (!selection_.accel_topic.empty()) {
      requireTopic(summary_.name, types_, selection_.accel_topic, {kImu});
    }
    for (std::string& topic : selection_.image_topics) {
      if (types_.count(topic) == 0 && types_.count(topic + "/compressed") > 0) {
        topic += "/compressed";
      }
      requireTopic(summary_.name, types_, topic, {kImage, kCompressed});
    }
  }

  bool isImage(const std::string& topic) const {
    const auto& topics = selection_.image_topics;
    return std::find(topics.begin(), topics.end(), topic) != topics.end();
  }

  bool isInertial(const std::string& topic) const {
    return topic == selection_.imu_topic || topic == selection_.accel_topic;
  }

  bool isSelected(const std::string& topic) const {
    return isInertial(topic) || isImage(topic) || topic == truth_topic_;
  }

  /// The types are told apart by the bag; that they mean what they mean here, by their definition.
  void requireDefinitions(const BagFile& file) const {
    for (const auto& [id, connection] : file.connections()) {
      if (!isSelected(connection.topic)) continue;
      requireTopic(file.path(), {{connection.topic, connection.type}}, connection.topic,
                   {types_.at(connection.topic)});
      if (connection.md5sum == definitionOf(connection.type)) continue;
      throw InputError(file.path() + ": " + connection.topic +
                       ": messages are of another definition than " + connection.type);
    }
  }

  void addMessages(BagFile* file) {
    for (const BagMessage& message : file->takeMessages()) {
      const Place place{file, message};
      if (isSelected(topicOf(place))) messages_.push_back(place);
    }
  }

  StampOrder::Stream streamOf(const std::string& topic) const {
    if (isInertial(topic)) return StampOrder::Stream::kImu;
    return topic == truth_topic_ ? StampOrder::Stream::kTruth : StampOrder::Stream::kImage;
  }

  void chooseSpan() {
    const auto [first, last] = flight();
    summary_.begin = first + toNanoseconds(selection_.start);
    summary_.end = selection_.duration
                       ? std::min(last, summary_.begin + toNanoseconds(*selection_.duration))
                       : last;
    if (summary_.begin <= last) return;
    std::ostringstream message;
    message << summary_.name << ": nothing from second " << selection_.start << " on; it is "
            << toSeconds(last - first) << " s long";
    throw InputError(message.str());
  }

  /// The first and the last arrival of IMU and images; ground truth may go beyond.
  std::pair<Stamp, Stamp> flight() const {
    std::optional<std::pair<Stamp, Stamp>> span;
    const auto extend = [&](const std::string& topic, Stamp stamp) {
      if (!isSelected(topic) || streamOf(topic) == StampOrder::Stream::kTruth) return;
      if (!span) span.emplace(stamp, stamp);
      span = {std::min(span->first, stamp), std::max(span->second, stamp)};
    };
    for (const Place& place : messages_) extend(topicOf(place), place.message.arrival);
    if (!span) throw InputError(summary_.name + ": has no messages");
    forEachLoss([&](const std::string& topic, const BagLoss& loss) { extend(topic, loss.end); });
    return *span;
  }

  template <typename Function>
  void forEachLoss(const Function& function) const {
    for (const BagFile& file : files_) {
      for (const BagLoss& loss : file.lost()) {
        const auto connection = file.connections().find(loss.connection);
        if (connection != file.connections().end()) function(connection->second.topic, loss);
      }
    }
  }

  void countOne(const std::string& topic, std::size_t count) {
    if (topic == selection_.imu_topic) summary_.imu_samples += count;
    if (isImage(topic)) summary_.images += count;
    if (topic == truth_topic_) summary_.truth_poses += count;
  }

  /// Drops what lies outside the span, and counts what lies inside, lost messages included.
  void keepSpan() {
    for (BagFile& file : files_) reached_[&file] = summary_.begin;
    for (const Place& place : messages_) {
      Stamp& reached = reached_[place.file];
      reached = std::max(reached, place.message.arrival);
    }
    const auto is_outside = [this](const Place& place) {
      return place.message.arrival < summary_.begin || place.message.arrival > summary_.end;
    };
    messages_.erase(std::remove_if(messages_.begin(), messages_.end(), is_outside),
                    messages_.end());
    for (const Place& place : messages_) countOne(topicOf(place), 1);
    forEachLoss([this](const std::string& topic, const BagLoss& loss) {
      if (loss.begin >= summary_.begin && loss.begin <= summary_.end) countOne(topic, loss.count);
    });
    if (summary_.truth_poses > 0) summary_.truth_source = summary_.name + ":" + truth_topic_;
  }

  /// Says which files end before their end, within the span.
  void describeEnds() {
    for (const BagFile& file : files_) {
      const Stamp reached = reached_.at(&file);
      if (selection_.duration && reached >= summary_.end) continue;
      std::ostringstream second;
      second << toSeconds(reached - summary_.begin);
      if (!file.damage().empty()) {
        summary_.damage += (summary_.damage.empty() ? "" : "; ") + file.path() +
                           ": is damaged behind second " + second.str() +
                           ", up to which it is used: " + file.damage();
      } else if (!file.isClosed()) {
        summary_.interruption += (summary_.interruption.empty() ? "" : "; ") + file.path() +
                                 ": was not closed when it was recorded; it is used up to its "
                                 "end, second " +
                                 second.str();
      }
    }
  }

  template <typename Message>
  static Message read(const Place& place) {
    return readMessage<Message>(place.file->read(place.message));
  }

  Data dataOf(const Place& place) {
    const std::string& topic = topicOf(place);
    if (isImage(topic)) return imageOf(place);
    try {
      if (topic == truth_topic_) return truthOf(place);
      const ImuSample sample = vins_msgs::fromMsg(read<sensor_msgs::Imu>(place));
      if (topic == selection_.imu_topic) return sample;
      return RecordedAcceleration{sample.stamp, sample.acceleration};
    } catch (const InputError& error) {
      throw InputError(place.file->path() + ": " + topic + ": " + error.what());
    }
  }

  /// An image is read when it is asked for, so that those that wait cost no memory.
  RecordedImage imageOf(const Place& place) {
    const auto& topics = selection_.image_topics;
    const auto camera = std::find(topics.begin(), topics.end(), topicOf(place)) - topics.begin();
    RecordedImage image;
    image.camera = static_cast<int>(camera);
    image.stamp = place.message.stamp;
    image.load = [place, converter = &converters_[static_cast<std::size_t>(camera)]] {
      try {
        return connectionOf(place).type == kImage
                   ? converter->toGrey(read<sensor_msgs::Image>(place))
                   : converter->toGrey(read<sensor_msgs::CompressedImage>(place));
      } catch (const InputError& error) {
        throw InputError(placeOf(place.file->path(), topicOf(place), place.message.stamp) + ": " +
                         error.what());
      }
    };
    return image;
  }

  RecordedTruth truthOf(const Place& place) const {
    const Stamp stamp = place.message.stamp;
    const std::string& type = connectionOf(place).type;
    if (type == kPose) {
      return {stamp, vins_msgs::fromMsg(read<geometry_msgs::PoseStamped>(place).pose), true};
    }
    if (type == kTransform) {
      const auto transform = read<geometry_msgs::TransformStamped>(place).transform;
      geometry_msgs::Pose pose;
      pose.position.x = transform.translation.x;
      pose.position.y = transform.translation.y;
      pose.position.z = transform.translation.z;
      pose.orientation = transform.rotation;
      return {stamp, vins_msgs::fromMsg(pose), true};
    }
    const auto point = read<geometry_msgs::PointStamped>(place).point;
    return {stamp, Pose(Eigen::Quaterniond::Identity(), {point.x, point.y, point.z}), false};
  }

  RecordingSelection selection_;
  std::deque<BagFile> files_;
  TopicTypes types_;
  std::string truth_topic_;
  std::vector<vins_msgs::ImageConverter> converters_;  ///< one per image topic
  std::vector<Place> messages_;                        ///< by arrival
  std::map<const BagFile*, Stamp> reached_;            ///< the latest arrival that could be read
  StampOrder order_;                                   ///< of `messages_`
  std::size_t next_ = 0;
};

void requireOnce(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> known;
  for (const std::string& path : paths) {
    if (!known.insert(std::filesystem::canonical(path)).second) {
      throw InputError(path + ": is given twice");
    }
  }
}

}  // namespace

std::unique_ptr<Recording> openBagRecording(const std::vector<std::string>& paths,
                                            const RecordingSelection& selection) {
  selection.validate();
  if (paths.empty()) throw InputError("recording: no bag is given");
  requireOnce(paths);
  return std::make_unique<BagRecording>(paths, selection);
}

std::unique_ptr<Recording> openRecording(const std::vector<std::string>& paths,
                                         const RecordingSelection& selection) {
  for (const std::string& path : paths) {
    if (std::filesystem::is_regular_file(path)) continue;
    if (!std::filesystem::is_directory(path)) {
      throw InputError(path + ": is not there; allowed: a bag, or a folder in the ASL layout");
    }
    if (paths.size() == 1) return openAslRecording(path, selection);
    throw InputError(path + ": is a folder; several recordings in a row must be bags");
  }
  return openBagRecording(paths, selection);
}

}  // namespace vins::pipeline
