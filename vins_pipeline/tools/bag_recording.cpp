#include "vins_pipeline/bag_recording.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Header.h>

#include "vins_core/input_error.h"
#include "vins_msgs/camera_info.h"
#include "vins_msgs/conversions.h"
#include "vins_msgs/image_converter.h"
#include "vins_pipeline/stamp_order.h"

namespace vins::pipeline {
namespace {

using Types = std::map<std::string, std::string>;  ///< of the bag's topics

constexpr char kImage[] = "sensor_msgs/Image";
constexpr char kCompressed[] = "sensor_msgs/CompressedImage";
constexpr char kCameraInfo[] = "sensor_msgs/CameraInfo";
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

/// The stamp of a message's header, which comes first in every type that is read here.
Stamp headerStampOf(const rosbag::MessageInstance& instance, std::vector<std::uint8_t>* buffer) {
  buffer->resize(instance.size());
  ros::serialization::OStream out(buffer->data(), instance.size());
  instance.write(out);
  ros::serialization::IStream in(buffer->data(), instance.size());
  std_msgs::Header header;
  ros::serialization::deserialize(in, header);
  return vins_msgs::toStamp(header.stamp);
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
    if (!selection.accel_topic.empty()) {
      requireTopic(path, types_, selection.accel_topic, {kImu});
      topics.push_back(selection.accel_topic);
    }
    for (std::string& topic : selection_.image_topics) {
      if (types_.count(topic) == 0 && types_.count(topic + "/compressed") > 0) {
        topic += "/compressed";
      }
      requireTopic(path, types_, topic, {kImage, kCompressed});
      topics.push_back(topic);
    }
    chooseSpan(topics);
    truth_topic_ = truthTopicOf(types_);
    if (!truth_topic_.empty()) topics.push_back(truth_topic_);
    converters_.resize(selection_.image_topics.size());
    view_.addQuery(bag_, rosbag::TopicQuery(topics), vins_msgs::toRosTime(summary_.begin),
                   vins_msgs::toRosTime(summary_.end));
    summarize();
    index();
  }

  std::optional<Record> next() override {
    if (next_ == order_.place().size()) return std::nullopt;
    const std::size_t place = order_.place()[next_++];
    const rosbag::MessageInstance& instance = messages_[place];
    try {
      return Record{vins_msgs::toStamp(instance.getTime()), dataOf(instance)};
    } catch (const ros::Exception& error) {
      throw InputError(summary_.name + ": is broken: " + error.what());
    }
  }

 private:
  using Data = decltype(Record::data);

  /// Reads all header stamps once, as far as the bag can be read.
  void index() {
    std::vector<std::uint8_t> buffer;
    Stamp reached = summary_.begin;
    try {
      for (const rosbag::MessageInstance& instance : view_) {
        const Stamp stamp = headerStampOf(instance, &buffer);
        reached = vins_msgs::toStamp(instance.getTime());
        messages_.push_back(instance);
        order_.add(streamOf(instance.getTopic()), stamp);
      }
    } catch (const ros::Exception& error) {
      std::ostringstream text;
      text << summary_.name << ": is damaged behind second " << toSeconds(reached - summary_.begin)
           << ", up to which it is used: " << error.what();
      summary_.damage = text.str();
    }
    order_.sort();
  }

  StampOrder::Stream streamOf(const std::string& topic) const {
    if (topic == selection_.imu_topic || topic == selection_.accel_topic) {
      return StampOrder::Stream::kImu;
    }
    return topic == truth_topic_ ? StampOrder::Stream::kTruth : StampOrder::Stream::kImage;
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

  Data dataOf(const rosbag::MessageInstance& instance) {
    const std::string& topic = instance.getTopic();
    if (topic == selection_.imu_topic) return vins_msgs::fromMsg(*read<sensor_msgs::Imu>(instance));
    if (topic == selection_.accel_topic) {
      const ImuSample sample = vins_msgs::fromMsg(*read<sensor_msgs::Imu>(instance));
      return RecordedAcceleration{sample.stamp, sample.acceleration};
    }
    if (topic == truth_topic_) return truthOf(instance);
    return imageOf(instance);
  }

  template <typename Message>
  RecordedImage loadable(const rosbag::MessageInstance& instance, std::size_t camera) {
    const auto message = read<Message>(instance);
    RecordedImage image;
    image.camera = static_cast<int>(camera);
    image.stamp = vins_msgs::toStamp(message->header.stamp);
    image.load = [message, converter = &converters_[camera],
                  place = placeOf(summary_.name, instance.getTopic(), image.stamp)] {
      try {
        return converter->toGrey(*message);
      } catch (const InputError& error) {
        throw InputError(place + ": " + error.what());
      }
    };
    return image;
  }

  RecordedImage imageOf(const rosbag::MessageInstance& instance) {
    const auto& topics = selection_.image_topics;
    const auto place = std::find(topics.begin(), topics.end(), instance.getTopic());
    const auto camera = static_cast<std::size_t>(place - topics.begin());
    return instance.getDataType() == kImage
               ? loadable<sensor_msgs::Image>(instance, camera)
               : loadable<sensor_msgs::CompressedImage>(instance, camera);
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
  std::vector<vins_msgs::ImageConverter> converters_;  ///< one per image topic
  std::deque<rosbag::MessageInstance> messages_;       ///< places in the bag, by arrival
  StampOrder order_;                                   ///< of `messages_`
  std::size_t next_ = 0;
};

}  // namespace

namespace {

/// Calls `open`, and says in words what kept a bag from being read.
template <typename Open>
auto explainingFailure(const std::string& path, Open open) -> decltype(open()) {
  try {
    return open();
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(path + ": has no index, because its recording did not end in order; run " +
                     "'rosbag reindex' on it");
  } catch (const rosbag::BagException& error) {
    throw InputError(path + ": cannot be read as a bag: " + error.what());
  }
}

}  // namespace

std::unique_ptr<Recording> openBagRecording(const std::string& path,
                                            const RecordingSelection& selection) {
  selection.validate();
  return explainingFailure(path, [&]() -> std::unique_ptr<Recording> {
    return std::make_unique<BagRecording>(path, selection);
  });
}

std::unique_ptr<camera_model::Camera> readCameraInfo(const std::string& path,
                                                     const std::string& topic) {
  const std::string recorded = topic.rfind('/', 0) == 0 ? topic : "/" + topic;
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(path + ": is no bag, which camera_info_topic '" + topic +
                     "' needs; allowed: the intrinsics in the file (model_type, ...)");
  }
  return explainingFailure(path, [&] {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    requireTopic(path, typesOf(bag), recorded, {kCameraInfo});
    rosbag::View view(bag, rosbag::TopicQuery(recorded));
    const auto message =
        view.size() > 0 ? view.begin()->instantiate<sensor_msgs::CameraInfo>() : nullptr;
    if (!message) throw InputError(path + ": has no message that can be read on " + recorded);
    return vins_msgs::cameraOf(*message, path + ": " + recorded);
  });
}

std::unique_ptr<Recording> openRecording(const std::string& path,
                                         const RecordingSelection& selection) {
  if (std::filesystem::is_directory(path)) return openAslRecording(path, selection);
  if (std::filesystem::is_regular_file(path)) return openBagRecording(path, selection);
  throw InputError(path + ": is not there; allowed: a bag, or a folder in the ASL layout");
}

}  // namespace vins::pipeline
