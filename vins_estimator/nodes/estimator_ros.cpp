#include "estimator_ros.h"

#include <cmath>
#include <utility>

#include "vins_core/input_error.h"
#include "vins_msgs/conversions.h"

namespace vins::estimator {
namespace {

constexpr std::size_t kMaxFramesWaiting = 40;  // two seconds at 20 Hz
constexpr std::size_t kRecentEvents = 5;
constexpr std::size_t kManyWaiting = 5;  // frames: a quarter of a second behind at 20 Hz
constexpr double kFindingLasts = 15.0;   // findings are told again every ten seconds [s]
constexpr double kSilence = 2.0;         // without input, before somebody is told [s]
const char* const kFeatureTopic = "feature_tracker/feature";

EstimatorOptions loadOptions(const vins_msgs::NodeConfiguration& configuration) {
  const EstimatorOptions options =
      readEstimatorOptions(configuration.parameters, configuration.rig);
  ROS_INFO_STREAM("estimator options:\n" << options);
  return options;
}

void log(const Event& event) {
  if (event.severity == Severity::kError) {
    ROS_ERROR_STREAM(event);
  } else if (event.code == "solver_time") {
    // With every frame on a slow machine: enough to say it now and then.
    ROS_WARN_STREAM_THROTTLE(5.0, event);
  } else if (event.severity == Severity::kWarning) {
    ROS_WARN_STREAM(event);
  } else {
    ROS_INFO_STREAM(event);
  }
}

/// Data that cannot be what they claim (ImuPlausibility, ImuJoiner); single samples aside.
bool isInputFinding(const Event& event) {
  if (event.code == "imu_gap" || event.code == "imu_disorder") return false;
  return event.code.rfind("imu_", 0) == 0 || event.code == "clocks_apart";
}

/// Converts, or says what is wrong with the message and drops it.
template <typename Message>
auto tryFromMsg(const Message& message) -> std::optional<decltype(vins_msgs::fromMsg(message))> {
  try {
    return vins_msgs::fromMsg(message);
  } catch (const InputError& error) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "dropped a message: " << error.what());
    return std::nullopt;
  }
}

}  // namespace

EstimatorRos::EstimatorRos(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : EstimatorRos(node, private_node, vins_msgs::loadConfiguration(node, private_node)) {}

EstimatorRos::EstimatorRos(ros::NodeHandle node, ros::NodeHandle private_node,
                           const vins_msgs::NodeConfiguration& configuration)
    : options_(loadOptions(configuration)),
      estimator_(options_),
      publisher_(private_node),
      propagator_(options_.imu),
      diagnostics_(node, private_node) {
  camera_model::requireImuTopic(configuration.parameters, configuration.rig);
  diagnostics_.setHardwareID("visual-inertial rig");
  diagnostics_.add("estimator", this, &EstimatorRos::report);
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  if (!configuration.rig.imu.accel_topic.empty()) {
    joiner_.emplace();
    acceleration_ = node.subscribe(configuration.rig.imu.accel_topic, 2000,
                                   &EstimatorRos::onAcceleration, this, no_delay);
  }
  imu_ = node.subscribe(configuration.rig.imu.topic, 2000, &EstimatorRos::onImu, this, no_delay);
  features_ = node.subscribe(kFeatureTopic, 100, &EstimatorRos::onFeatures, this, no_delay);
  matches_ = node.subscribe("pose_graph/loop_match", 100, &EstimatorRos::onLoopMatch, this);
  restarts_ = node.subscribe("feature_tracker/restart", 10, &EstimatorRos::onRestart, this);
  reset_ = private_node.advertiseService("reset", &EstimatorRos::onReset, this);
  timer_ = node.createTimer(ros::Duration(1.0),
                            [this](const ros::TimerEvent&) { diagnostics_.update(); });
  worker_ = std::thread([this] { work(); });
}

EstimatorRos::~EstimatorRos() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  arrived_.notify_one();
  worker_.join();
}

void EstimatorRos::onImu(const sensor_msgs::Imu::ConstPtr& message) {
  const std::optional<ImuSample> sample = tryFromMsg(*message);
  if (!sample) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_imu_ = ros::WallTime::now();
  }
  if (!joiner_) return takeSample(*sample);
  const std::lock_guard<std::mutex> lock(joiner_mutex_);
  joiner_->addGyroscope(sample->stamp, sample->angular_velocity);
  takeJoinedSamples();
}

void EstimatorRos::onAcceleration(const sensor_msgs::Imu::ConstPtr& message) {
  const std::optional<ImuSample> sample = tryFromMsg(*message);
  if (!sample) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_acceleration_ = ros::WallTime::now();
  }
  const std::lock_guard<std::mutex> lock(joiner_mutex_);
  joiner_->addAccelerometer(sample->stamp, sample->acceleration);
  takeJoinedSamples();
}

void EstimatorRos::takeJoinedSamples() {
  while (const std::optional<ImuSample> sample = joiner_->next()) takeSample(*sample);
  Input input;
  input.events = joiner_->takeEvents();
  if (!input.events.empty()) push(std::move(input));
}

void EstimatorRos::takeSample(const ImuSample& sample) {
  Input input;
  input.imu = sample;
  {
    const std::lock_guard<std::mutex> lock(propagator_mutex_);
    const std::optional<PropagatedState> state = propagator_.addImu(sample);
    if (state) publisher_.publish(*state);
  }
  push(std::move(input));
}

void EstimatorRos::onFeatures(const vins_msgs::FeatureFrame::ConstPtr& message) {
  Input input;
  input.frame = tryFromMsg(*message);
  if (!input.frame) return;
  if (numbering_.take(&*input.frame)) ROS_WARN("the feature tracker has been started again");
  push(std::move(input));
}

void EstimatorRos::onLoopMatch(const vins_msgs::LoopMatch::ConstPtr& message) {
  Input input;
  input.match = tryFromMsg(*message);
  if (input.match) push(std::move(input));
}

void EstimatorRos::onRestart(const std_msgs::Bool::ConstPtr& message) {
  if (!message->data) return;
  Input input;
  input.restart = true;
  push(std::move(input));
}

bool EstimatorRos::onReset(std_srvs::Trigger::Request& /*request*/,
                           std_srvs::Trigger::Response& response) {
  Input input;
  input.restart = true;
  push(std::move(input));
  response.success = true;
  response.message = "the estimator starts anew";
  return true;
}

void EstimatorRos::push(Input input) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (input.frame) {
      last_frame_ = ros::WallTime::now();
      // Falling behind for good: new frames are left out, the IMU goes on.
      if (frames_waiting_ >= kMaxFramesWaiting) {
        ++frames_dropped_;
        return;
      }
      ++frames_waiting_;
    }
    queue_.push_back(std::move(input));
  }
  arrived_.notify_one();
}

void EstimatorRos::work() {
  while (true) {
    std::deque<Input> inputs;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      arrived_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      inputs.swap(queue_);
    }
    for (Input& input : inputs) {
      handle(&input);
      handleResults();
    }
  }
}

void EstimatorRos::handle(Input* input) {
  if (input->restart) restart();
  if (!input->events.empty()) handle(input->events);
  if (input->imu) estimator_.addImu(*input->imu);
  if (input->match) estimator_.addLoopMatch(*input->match);
  if (input->frame) {
    estimator_.addFrame(*std::move(input->frame));
    const std::lock_guard<std::mutex> lock(mutex_);
    --frames_waiting_;
    estimator_.setBacklog(static_cast<int>(frames_waiting_));
  }
}

void EstimatorRos::handleResults() {
  while (const std::optional<EstimatorResult> result = estimator_.process()) handle(*result);
  handle(estimator_.takeInputEvents());
}

void EstimatorRos::handle(const std::vector<Event>& events) {
  for (const Event& event : events) log(event);
  publisher_.publish(events);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const Event& event : events) {
    recent_.push_back(event);
    keepFinding(event);
  }
  while (recent_.size() > kRecentEvents) recent_.pop_front();
}

void EstimatorRos::keepFinding(const Event& event) {
  if (isInputFinding(event)) {
    finding_ = event.text;
    finding_time_ = ros::WallTime::now();
  }
  if (event.code.rfind("rig_", 0) == 0) {
    rig_finding_ = event.code == "rig_agrees" ? "" : event.text;
  }
}

void EstimatorRos::handle(const EstimatorResult& result) {
  handle(result.events);
  if (result.odometry) {
    const Stamp solved = result.odometry->stamp + toNanoseconds(result.rig.td);
    const std::lock_guard<std::mutex> lock(propagator_mutex_);
    propagator_.setState(solved, result.odometry->state, result.odometry->covariance);
  }
  publisher_.publish(result);
  const std::lock_guard<std::mutex> lock(mutex_);
  latest_ = {result.status, result.statistics, result.rig.td, result.rig_covariance(6, 6),
             result.scale_sigma};
}

void EstimatorRos::restart() {
  ROS_WARN("starting anew");
  estimator_.reset();
  publisher_.clear();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    rig_finding_.clear();
  }
  const std::lock_guard<std::mutex> lock(propagator_mutex_);
  propagator_.reset();
}

std::string EstimatorRos::missingInput() const {
  const ros::WallTime now = ros::WallTime::now();
  if (last_imu_.isZero()) {
    return "no IMU sample yet on " + imu_.getTopic() +
           ": does the IMU or the bag run, is imu_topic right? (rostopic hz)";
  }
  if (joiner_ && last_acceleration_.isZero()) {
    return "no accelerometer sample yet on " + acceleration_.getTopic() +
           ": is accel_topic right, is the accelerometer switched on? (rostopic hz)";
  }
  if (last_frame_.isZero()) {
    return "no features yet on " + features_.getTopic() + ": does feature_tracker run?";
  }
  if ((now - last_imu_).toSec() > kSilence) {
    return "IMU samples have stopped on " + imu_.getTopic() +
           ": has the bag ended, has the IMU's driver stopped?";
  }
  if (joiner_ && (now - last_acceleration_).toSec() > kSilence) {
    return "accelerometer samples have stopped on " + acceleration_.getTopic() +
           ": has the bag ended, has the driver stopped?";
  }
  if ((now - last_frame_).toSec() > kSilence) {
    return "features have stopped on " + features_.getTopic() +
           ": have images stopped, or feature_tracker?";
  }
  return "";
}

std::string EstimatorRos::inputFinding() const {
  const bool is_old = (ros::WallTime::now() - finding_time_).toSec() > kFindingLasts;
  return is_old ? "" : finding_;
}

std::string EstimatorRos::waitingReason() const {
  for (auto event = recent_.rbegin(); event != recent_.rend(); ++event) {
    if (event->code.rfind("init_", 0) == 0) return event->text;
  }
  return "initializing: move the camera sideways and up and down, with texture in view";
}

void EstimatorRos::summarize(diagnostic_updater::DiagnosticStatusWrapper* status) {
  using diagnostic_msgs::DiagnosticStatus;
  // Bad inputs come first: they are why the rest fails.
  const std::string finding = inputFinding();
  if (latest_.status != EstimatorStatus::kTracking && !finding.empty()) {
    return status->summary(DiagnosticStatus::WARN, finding);
  }
  const std::string missing = missingInput();
  if (!missing.empty()) return status->summary(DiagnosticStatus::WARN, missing);
  if (latest_.status == EstimatorStatus::kTracking) {
    status->summary(DiagnosticStatus::OK,
                    latest_.scale_sigma ? "tracking; the scale converges: move on" : "tracking");
  } else {
    status->summary(DiagnosticStatus::WARN, waitingReason());
  }
  if (latest_.statistics.features < options_.min_tracks) {
    status->mergeSummary(DiagnosticStatus::WARN,
                         "too few features: is the lens free, is there light?");
  }
  if (!rig_finding_.empty()) status->mergeSummary(DiagnosticStatus::WARN, rig_finding_);
  if (frames_waiting_ >= kManyWaiting || frames_dropped_ > frames_dropped_told_) {
    status->mergeSummary(DiagnosticStatus::WARN,
                         "falls behind: lower max_cnt or max_num_iterations, set motion_only_ba "
                         "to 1 or freq to 10, or free the processor");
  }
  frames_dropped_told_ = frames_dropped_;
}

void EstimatorRos::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  summarize(&status);
  status.add("state", latest_.scale_sigma ? "converging" : toString(latest_.status));
  if (latest_.scale_sigma) status.add("scale, deviation [%]", 100.0 * *latest_.scale_sigma);
  status.add("features", latest_.statistics.features);
  status.add("landmarks", latest_.statistics.landmarks);
  status.add("motion-only adjustment", latest_.statistics.motion_only);
  status.add("time offset [s]", latest_.td);
  status.add("time offset, deviation [s]", std::sqrt(latest_.td_variance));
  status.add("solve time [ms]", 1e3 * latest_.statistics.solve_seconds);
  status.add("marginalization time [ms]", 1e3 * latest_.statistics.marginalize_seconds);
  status.add("frames waiting", frames_waiting_);
  status.add("frames dropped", frames_dropped_);
  for (const Event& event : recent_) status.add("event " + event.code, event.text);
}

}  // namespace vins::estimator
