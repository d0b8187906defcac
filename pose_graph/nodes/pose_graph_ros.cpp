#include "pose_graph_ros.h"

#include <utility>

#include <ros/package.h>

#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"

namespace vins::pose_graph {
namespace {

constexpr std::size_t kMaxWaiting = 400;  // several seconds of keyframes and odometries
constexpr double kRecentImages = 3.0;     // the estimator may be behind [s]
constexpr std::size_t kRecentEvents = 5;

std::unique_ptr<PoseGraph> makeGraph(const camera_model::Rig& rig,
                                     const PoseGraphConfiguration& configuration) {
  const std::string shipped = ros::package::getPath("pose_graph") + "/support_files";
  ROS_INFO_STREAM("pose graph options:\n" << configuration.options);
  return std::make_unique<PoseGraph>(configuration.options, rig.cameras.front().camera,
                                     readPlaceModel(configuration.files, shipped));
}

void log(const Event& event) {
  if (event.severity == Severity::kInfo) {
    ROS_INFO_STREAM(event);
  } else {
    ROS_WARN_STREAM(event);
  }
}

/// The image in grey values; empty, and said so, where it cannot be had.
template <typename Message>
cv::Mat toGrey(const Message& message, vins_msgs::ImageConverter* converter) {
  try {
    return converter->toGrey(message);
  } catch (const InputError& error) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "dropped an image: " << error.what());
    return {};
  }
}

}  // namespace

PoseGraphRos::PoseGraphRos(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : PoseGraphRos(node, private_node, vins_msgs::loadConfiguration(node, private_node)) {}

PoseGraphRos::PoseGraphRos(ros::NodeHandle node, ros::NodeHandle private_node,
                           const vins_msgs::NodeConfiguration& configuration)
    : configuration_(readPoseGraphConfiguration(configuration.parameters)),
      publisher_(private_node),
      pictures_(static_cast<std::size_t>(configuration_.options.thinning.max_keyframes)),
      images_(kRecentImages),
      diagnostics_(node, private_node) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("pose graph", this, &PoseGraphRos::report);
  timer_ = node.createTimer(ros::Duration(1.0),
                            [this](const ros::TimerEvent&) { diagnostics_.update(); });
  if (!configuration_.is_on) {
    ROS_WARN("loop_closure is 0: the map is the odometry's world");
    const boost::function<void(const nav_msgs::Odometry::ConstPtr&)> pass =
        [this](const nav_msgs::Odometry::ConstPtr& message) {
          publisher_.publish(*message, MapFromOdom());
        };
    subscribers_.push_back(
        node.subscribe<nav_msgs::Odometry>("vins_estimator/odometry", 200, pass));
    return;
  }
  camera_model::requireImageTopic(configuration.parameters, configuration.rig);
  image_topic_ = configuration.rig.cameras.front().image_topic;
  if (private_node.param("image_transport", std::string("raw")) == "compressed") {
    is_compressed_ = true;
    image_topic_ += "/compressed";
  }
  graph_ = makeGraph(configuration.rig, configuration_);
  private_node.param("save_map", save_at_end_, save_at_end_);
  loadFirstMap(private_node);
  subscribe(node);
  services_ = std::make_unique<MapServices>(
      private_node, [this](MapRequest request) { push(std::move(request)); });
  // Last: what has thrown must not leave a thread behind.
  worker_ = std::thread([this] { work(); });
}

PoseGraphRos::~PoseGraphRos() { stop(); }

void PoseGraphRos::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  arrived_.notify_one();
  if (worker_.joinable()) worker_.join();
  const std::lock_guard<std::mutex> lock(mutex_);
  queue_.clear();  // who waits for an answer is told that there will be none
}

void PoseGraphRos::finish() {
  stop();
  if (!graph_ || save_at_end_.empty()) return;
  if (graph_->statistics().keyframes == 0) {
    ROS_WARN_STREAM(save_at_end_ << ": not written: there was no keyframe");
    return;
  }
  graph_->finish();
  ROS_INFO_STREAM(saveMap(save_at_end_));
}

void PoseGraphRos::loadFirstMap(const ros::NodeHandle& private_node) {
  std::string file;
  private_node.param("load_map", file, file);
  if (file.empty() && configuration_.loads_map) file = configuration_.map_file;
  if (!file.empty()) ROS_INFO_STREAM(loadMap(file));
}

std::string PoseGraphRos::saveMap(const std::string& file) {
  graph_->waitUntilIdle();
  const std::size_t keyframes =
      graph_->save(file, configuration_.saves_images ? &pictures_ : nullptr);
  return "saved " + file + ": " + std::to_string(keyframes) + " keyframes";
}

std::string PoseGraphRos::loadMap(const std::string& file) {
  const LoadedMap loaded = graph_->load(file, &pictures_);
  publisher_.publishPaths(graph_.get(), true);
  return "loaded " + file + ": " + loaded.describe();
}

void PoseGraphRos::subscribe(ros::NodeHandle node) {
  subscribeImages(&node);
  const auto take = [&](auto message, const std::string& topic) {
    using Message = decltype(message);
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [this](const boost::shared_ptr<const Message>& received) {
          try {
            push(vins_msgs::fromMsg(*received));
          } catch (const InputError& error) {
            ROS_ERROR_STREAM_THROTTLE(1.0, "dropped a message: " << error.what());
          }
        };
    subscribers_.push_back(node.subscribe<Message>("vins_estimator/" + topic, 200, callback));
  };
  take(vins_msgs::Keyframe(), "keyframe");
  take(vins_msgs::KeyframePoseUpdate(), "keyframe_pose_update");
  take(vins_msgs::LoopEdge(), "loop_edge");
  const boost::function<void(const nav_msgs::Odometry::ConstPtr&)> take_odometry =
      [this](const nav_msgs::Odometry::ConstPtr& message) { push(*message); };
  subscribers_.push_back(
      node.subscribe<nav_msgs::Odometry>("vins_estimator/odometry", 200, take_odometry));
}

void PoseGraphRos::subscribeImages(ros::NodeHandle* node) {
  if (is_compressed_) {
    const boost::function<void(const sensor_msgs::CompressedImageConstPtr&)> take =
        [this](const sensor_msgs::CompressedImageConstPtr& message) {
          onImage(message->header.stamp, {nullptr, message});
        };
    subscribers_.push_back(node->subscribe<sensor_msgs::CompressedImage>(image_topic_, 10, take));
    return;
  }
  const boost::function<void(const sensor_msgs::ImageConstPtr&)> take =
      [this](const sensor_msgs::ImageConstPtr& message) {
        onImage(message->header.stamp, {message, nullptr});
      };
  subscribers_.push_back(node->subscribe<sensor_msgs::Image>(image_topic_, 10, take));
}

void PoseGraphRos::onImage(const ros::Time& stamp, const ImageMessage& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  images_.add(vins_msgs::toStamp(stamp), message);
}

cv::Mat PoseGraphRos::imageOf(Stamp stamp) {
  ImageMessage message;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    message = images_.find(stamp);
  }
  // Only a few images become keyframes: the others are never converted.
  cv::Mat image;
  if (message.raw) image = toGrey(*message.raw, &converter_);
  if (message.compressed) image = toGrey(*message.compressed, &converter_);
  if (image.empty()) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++without_image_;
  }
  return image;
}

void PoseGraphRos::push(Input input) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopping_) return;
    // Falling behind for good: what is newest is left out. People's wishes are not.
    if (queue_.size() >= kMaxWaiting && !std::holds_alternative<MapRequest>(input)) {
      ++dropped_;
      return;
    }
    queue_.push_back(std::move(input));
  }
  arrived_.notify_one();
}

void PoseGraphRos::work() {
  while (true) {
    std::deque<Input> inputs;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      statistics_ = graph_->statistics();
      arrived_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      inputs.swap(queue_);
    }
    for (const Input& input : inputs) {
      try {
        std::visit([this](const auto& value) { handle(value); }, input);
      } catch (const InputError& error) {
        ROS_ERROR_STREAM_THROTTLE(1.0, "dropped a keyframe: " << error.what());
      }
    }
  }
}

void PoseGraphRos::handle(Keyframe keyframe) {
  if (numbering_.take(&keyframe)) ROS_WARN("the estimator has been started again");
  const cv::Mat image = imageOf(keyframe.stamp);
  const PoseGraphResult result = graph_->addKeyframe(keyframe, image);
  sequence_ = keyframe.sequence;
  for (const nav_msgs::Odometry& odometry : hold_.addKeyframe(keyframe)) correct(odometry);
  if (result.match && configuration_.options.refines_in_window) {
    LoopMatch match = *result.match;
    numbering_.giveBack(&match);
    publisher_.publish(match);
  }
  hear(result.events);
  if (result.is_kept) showLoop(keyframe, image, result);
  publisher_.publishPaths(graph_.get(), result.match.has_value());
}

void PoseGraphRos::showLoop(const Keyframe& keyframe, const cv::Mat& image,
                            const PoseGraphResult& result) {
  if (image.empty()) return;
  if (configuration_.saves_images || publisher_.wantsPictures()) pictures_.add(keyframe.id, image);
  if (!result.match || !publisher_.wantsPictures()) return;
  const cv::Mat old_image = pictures_.find(result.match->old_id, image.size());
  publisher_.publishPicture(keyframe.stamp,
                            graph_->draw(result.search.checked.back(), image, old_image));
}

void PoseGraphRos::handle(KeyframePoseUpdate update) {
  numbering_.take(&update);
  graph_->update(update);
}

void PoseGraphRos::handle(LoopEdge edge) {
  numbering_.take(&edge);
  hear(graph_->addLoopEdge(edge).events);
}

void PoseGraphRos::handle(const MapRequest& request) {
  const std::string& file = request.file.empty() ? configuration_.map_file : request.file;
  vins_msgs::MapFile::Response answer;
  try {
    if (file.empty()) throw InputError("no file was named, and pose_graph_save_path is not set");
    answer.message = request.saves ? saveMap(file) : loadMap(file);
    answer.success = true;
    ROS_INFO_STREAM(answer.message);
  } catch (const InputError& error) {
    answer.success = false;
    answer.message = error.what();
    ROS_ERROR_STREAM(answer.message);
  }
  request.answer->set_value(answer);
}

void PoseGraphRos::handle(const nav_msgs::Odometry& odometry) {
  for (const nav_msgs::Odometry& released : hold_.addOdometry(odometry)) correct(released);
}

void PoseGraphRos::correct(const nav_msgs::Odometry& odometry) {
  publisher_.publish(odometry, graph_->locate(sequence_, vins_msgs::fromMsg(odometry.pose.pose)));
}

void PoseGraphRos::hear(const std::vector<Event>& events) {
  for (const Event& event : events) log(event);
  publisher_.publish(events);
  const std::lock_guard<std::mutex> lock(mutex_);
  recent_.insert(recent_.end(), events.begin(), events.end());
  while (recent_.size() > kRecentEvents) recent_.pop_front();
}

void PoseGraphRos::summarize(diagnostic_updater::DiagnosticStatusWrapper* status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!configuration_.is_on) {
    return status->summary(DiagnosticStatus::OK, "loop closing is off (loop_closure: 0)");
  }
  const bool is_empty = statistics_.keyframes == 0;
  status->summary(DiagnosticStatus::OK, is_empty ? "no keyframe yet" : "mapping");
  if (without_image_ > 0 && without_image_ * 2 > statistics_.keyframes) {
    status->mergeSummary(DiagnosticStatus::WARN,
                         "most keyframes come without an image: no loops will be found; does " +
                             image_topic_ + " reach this node? (rostopic hz)");
  }
  if (dropped_ > dropped_told_) {
    status->mergeSummary(DiagnosticStatus::WARN,
                         "falls behind: set skip_cnt or raise skip_dis, or free the processor");
  }
  dropped_told_ = dropped_;
}

void PoseGraphRos::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  summarize(&status);
  status.add("keyframes", statistics_.keyframes);
  status.add("keyframes left out", statistics_.skipped);
  status.add("keyframes without image", without_image_);
  status.add("sequences", statistics_.sequences);
  status.add("loops", statistics_.loops);
  status.add("loops refined", statistics_.refined);
  status.add("candidates rejected", statistics_.describeRejected());
  status.add("optimizations", statistics_.optimizations);
  status.add("memory [MB]", 1e-6 * static_cast<double>(statistics_.memory));
  status.add("messages waiting", queue_.size());
  status.add("messages dropped", dropped_);
  for (const Event& event : recent_) status.add("event " + event.code, event.text);
}

}  // namespace vins::pose_graph
