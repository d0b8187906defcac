#include "vins_pipeline/bag_recording.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/image_encodings.h>

#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"

namespace vins::pipeline {
namespace {

using Types = std::map<std::string, std::string>;  ///< of the bag's topics

constexpr char kImage[] = "sensor_msgs/Image";
constexpr char kCompressed[] = "sensor_msgs/CompressedImage";
constexpr char kImu[] = "sensor_msgs/Imu";
constexpr char kPose[] = "geometry_msgs/PoseStamped";
constexpr char kTransform[] = "geometry_msgs/TransformStamped";
constexpr char kPoint[] = "geometry_msgs/PointStamped";

Types typesOf(const rosbag::Bag& bag) {
  Types types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    types[connection->topic] = connection->datatype;
  }
  return types;
}

std::string listOf(const Types& types) {
  std::string text;
  for (const auto& [topic, type] : types) {
    text += (text.empty() ? "" : ", ") + topic + " (" + type + ")";
  }
  return text.empty() ? "no topics" : text;
}

void requireTopic(const std::string& path, const Types& types, const std::string& topic,
                  const std::vector<std::string>& allowed) {
  const auto found = types.find(topic);
  if (found == types.end()) {
    throw InputError(path + ": has no topic '" + topic + "'; it has " + listOf(types));
  }
  if (std::find(allowed.begin(), allowed.end(), found->second) != allowed.end()) return;
  std::string choices;
  for (const std::string& type : allowed) choices += (choices.empty() ? "" : " or ") + type;
  throw InputError(path + ": topic '" + topic + "' is of type " + found->second +
                   "; allowed: " + choices);
}

/// The topic of ground truth, or "".
std::string truthTopicOf(const Types& types) {
  for (const std::string topic :
       {"/ground_truth/pose", "/vicon/firefly_sbx/firefly_sbx", "/leica/position"}) {
    const auto found = types.find(topic);
    if (found == types.end()) continue;
    const std::string& type = found->second;
    if (type == kPose || type == kTransform || type == kPoint) return topic;
  }
  return "";
}

std::string placeOf(const std::string& bag, const std::string& topic, Stamp stamp) {
  return bag + ": " + topic + ": image at " + std::to_string(stamp) + " ns";
}

cv::Mat toGrey(const sensor_msgs::Image::ConstPtr& message, const std::string& place) {
  namespace encodings = sensor_msgs::image_encodings;
  try {
    // Drivers say 8UC1 where they mean grey values, which cv_bridge does not guess.
    const bool is_plain = message->encoding == "8UC1" || message->encoding == "16UC1";
    if (!is_plain) return cv_bridge::toCvShare(message, encodings::MONO8)->image.clone();
    sensor_msgs::Image grey = *message;
    grey.encoding = message->encoding == "8UC1" ? encodings::MONO8 : encodings::MONO16;
    return cv_bridge::toCvCopy(grey, encodings::MONO8)->image;
  } catch (const std::exception& error) {
    throw InputError(place + " of " + std::to_string(message->width) + "x" +
                     std::to_string(message->height) + " '" + message->encoding +
                     "' cannot be converted to grey values: " + error.what());
  }
}

cv::Mat decode(const sensor_msgs::CompressedImage::ConstPtr& message, const std::string& place) {
  cv::Mat image;
  if (!message->data.empty()) image = cv::imdecode(message->data, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError(place + " '" + message->format + "' cannot be decoded");
  return image;
}

class BagRecording : public Recording {
 public:
  BagRecording(const std::string& path, const RecordingSelection& selection)
      : selection_(selection) {
    summary_.name = path;
    bag_.open(path, rosbag::bagmode::Read);
    types_ = typesOf(bag_);
    requireTopic(path, types_, selection.imu_topic, {kImu});
    std::vector<std::string> topics = {selection.imu_topic};
    for (const std::string& topic : selection.image_topics) {
      requireTopic(path, types_, topic, {kImage, kCompressed});
      topics.push_back(topic);
    }
    chooseSpan(topics);
    truth_topic_ = truthTopicOf(types_);
    if (!truth_topic_.empty()) topics.push_back(truth_topic_);
    view_.addQuery(bag_, rosbag::TopicQuery(topics), vins_msgs::toRosTime(summary_.begin),
                   vins_msgs::toRosTime(summary_.end));
    summarize();
    place_ = view_.begin();
  }

  std::optional<Record> next() override {
    if (failure_) throw InputError(*failure_);
    if (place_ == view_.end()) return std::nullopt;
    try {
      const rosbag::MessageInstance& instance = *place_;
      Record record{vins_msgs::toStamp(instance.getTime()), dataOf(instance)};
      advance();
      return record;
    } catch (const rosbag::BagException& error) {
      throw InputError(summary_.name + ": is broken: " + error.what());
    }
  }

 private:
  using Data = std::variant<ImuSample, RecordedImage, RecordedTruth>;

  /// The message has been read: what breaks behind it is told when it is asked for.
  void advance() {
    try {
      ++place_;
    } catch (const rosbag::BagException& error) {
      failure_ = summary_.name + ": is broken: " + error.what();
    }
  }

  void chooseSpan(const std::vector<std::string>& topics) {
    rosbag::View view(bag_, rosbag::TopicQuery(topics));
    if (view.size() == 0) throw InputError(summary_.name + ": has no messages");
    const Stamp first = vins_msgs::toStamp(view.getBeginTime());
    const Stamp last = vins_msgs::toStamp(view.getEndTime());
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

  std::size_t count(const std::string& topic) const {
    return rosbag::View(bag_, rosbag::TopicQuery(topic), vins_msgs::toRosTime(summary_.begin),
                        vins_msgs::toRosTime(summary_.end))
        .size();
  }

  void summarize() {
    summary_.imu_samples = count(selection_.imu_topic);
    for (const std::string& topic : selection_.image_topics) summary_.images += count(topic);
    if (!truth_topic_.empty()) summary_.truth_poses = count(truth_topic_);
    if (summary_.truth_poses > 0) summary_.truth_source = summary_.name + ":" + truth_topic_;
  }

  template <typename Message>
  typename Message::ConstPtr read(const rosbag::MessageInstance& instance) const {
    const auto message = instance.instantiate<Message>();
    if (message) return message;
    throw InputError(summary_.name + ": " + instance.getTopic() +
                     ": a message is of another definition than " + instance.getDataType());
  }

  Data dataOf(const rosbag::MessageInstance& instance) const {
    const std::string& topic = instance.getTopic();
    if (topic == selection_.imu_topic) return vins_msgs::fromMsg(*read<sensor_msgs::Imu>(instance));
    if (topic == truth_topic_) return truthOf(instance);
    return imageOf(instance);
  }

  RecordedImage imageOf(const rosbag::MessageInstance& instance) const {
    const auto& topics = selection_.image_topics;
    const auto place = std::find(topics.begin(), topics.end(), instance.getTopic());
    RecordedImage image;
    image.camera = static_cast<int>(place - topics.begin());
    if (instance.getDataType() == kImage) {
      const auto message = read<sensor_msgs::Image>(instance);
      image.stamp = vins_msgs::toStamp(message->header.stamp);
      image.load = [message, place = placeOf(summary_.name, *place, image.stamp)] {
        return toGrey(message, place);
      };
    } else {
      const auto message = read<sensor_msgs::CompressedImage>(instance);
      image.stamp = vins_msgs::toStamp(message->header.stamp);
      image.load = [message, place = placeOf(summary_.name, *place, image.stamp)] {
        return decode(message, place);
      };
    }
    return image;
  }

  RecordedTruth truthOf(const rosbag::MessageInstance& instance) const {
    if (instance.getDataType() == kPose) {
      const auto message = read<geometry_msgs::PoseStamped>(instance);
      return {vins_msgs::toStamp(message->header.stamp), vins_msgs::fromMsg(message->pose), true};
    }
    if (instance.getDataType() == kTransform) {
      const auto message = read<geometry_msgs::TransformStamped>(instance);
      geometry_msgs::Pose pose;
      pose.position.x = message->transform.translation.x;
      pose.position.y = message->transform.translation.y;
      pose.position.z = message->transform.translation.z;
      pose.orientation = message->transform.rotation;
      return {vins_msgs::toStamp(message->header.stamp), vins_msgs::fromMsg(pose), true};
    }
    const auto message = read<geometry_msgs::PointStamped>(instance);
    const Eigen::Vector3d position(message->point.x, message->point.y, message->point.z);
    return {vins_msgs::toStamp(message->header.stamp),
            Pose(Eigen::Quaterniond::Identity(), position), false};
  }

  RecordingSelection selection_;
  rosbag::Bag bag_;
  Types types_;
  std::string truth_topic_;
  rosbag::View view_;
  rosbag::View::iterator place_;
  std::optional<std::string> failure_;
};

}  // namespace

std::unique_ptr<Recording> openBagRecording(const std::string& path,
                                            const RecordingSelection& selection) {
  selection.validate();
  try {
    return std::make_unique<BagRecording>(path, selection);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(path + ": has no index, because its recording did not end in order; run " +
                     "'rosbag reindex' on it");
  } catch (const rosbag::BagException& error) {
    throw InputError(path + ": cannot be read as a bag: " + error.what());
  }
}

std::unique_ptr<Recording> openRecording(const std::string& path,
                                         const RecordingSelection& selection) {
  if (std::filesystem::is_directory(path)) return openAslRecording(path, selection);
  if (std::filesystem::is_regular_file(path)) return openBagRecording(path, selection);
  throw InputError(path + ": is not there; allowed: a bag, or a folder in the ASL layout");
}

}  // namespace vins::pipeline
