#include "vins_pipeline/pipeline.h"

#include <utility>

#include "feature_tracker/mask_file.h"
#include "vins_core/input_error.h"

namespace vins::pipeline {
namespace {

constexpr std::size_t kMaxWaiting = 200;  ///< images: ten seconds at 20 Hz
constexpr Stamp kJump = 1'000'000'000;    ///< stamps that fall by more begin a new run [ns]
/// Images kept for keyframes to come: more than the time in which one is chosen [s].
constexpr double kRecentImages = pose_graph::kLongestChoice + 0.2;

void append(std::vector<Event>* all, const std::vector<Event>& events) {
  all->insert(all->end(), events.begin(), events.end());
}

std::optional<pose_graph::PictureStore> makePictures(
    const pose_graph::PoseGraphConfiguration& loops) {
  if (!loops.saves_images) return std::nullopt;
  return pose_graph::PictureStore(static_cast<std::size_t>(loops.options.thinning.max_keyframes));
}

std::unique_ptr<pose_graph::PoseGraph> makePoseGraph(const PipelineOptions& options) {
  if (!options.loops.is_on || !options.places.vocabulary) return nullptr;
  return std::make_unique<pose_graph::PoseGraph>(options.loops.options, options.cameras.front(),
                                                 options.places);
}

void add(const Duration& more, Duration* sum) {
  sum->wall += more.wall;
  sum->cpu += more.cpu;
}

/// The name that a topic of the configuration has in a bag, where names are absolute; says so where
/// it is another.
std::string recordedTopic(const std::string& topic, const std::string& fallback,
                          std::vector<std::string>* remarks) {
  if (topic.empty()) return fallback;
  if (topic.front() == '/') return topic;
  remarks->push_back("topic '" + topic + "' is looked for as '/" + topic + "' in the recording");
  return "/" + topic;
}

/// A part of a stage, where it has worked at all.
void addPart(const char* stage, double seconds, PipelineResult* result) {
  if (seconds > 0.0) result->durations.emplace_back(stage, Duration{seconds, 0.0});
}

}  // namespace

PipelineOptions readPipelineOptions(const std::string& path, std::vector<std::string>* warnings,
                                    const camera_model::CameraInfoReader& read_camera_info) {
  const Parameters parameters = Parameters::load(path);
  const camera_model::Rig rig = camera_model::readRig(parameters, read_camera_info);
  const camera_model::RigCamera& camera = rig.cameras.front();
  PipelineOptions options;
  options.cameras = {camera.camera};
  options.tracker = feature_tracker::readFeatureTrackerOptions(parameters, rig);
  options.estimator = estimator::readEstimatorOptions(parameters, rig);
  options.mask =
      feature_tracker::readMaskFile(options.tracker.mask_file, camera.camera->imageSize());
  std::vector<std::string> remarks = rig.warnings;
  options.imu_topic = recordedTopic(rig.imu.topic, options.imu_topic, &remarks);
  if (!rig.imu.accel_topic.empty()) {
    options.accel_topic = recordedTopic(rig.imu.accel_topic, "", &remarks);
  }
  options.image_topics[0] = recordedTopic(camera.image_topic, options.image_topics[0], &remarks);
  if (!camera.is_from_topic) options.camera_info_topic = camera.camera_info_topic;
  options.loops = pose_graph::readPoseGraphConfiguration(parameters);
  if (options.loops.is_on && options.loops.loads_map) options.map = options.loops.map_file;
  // Of VINS-Mono, and of no meaning here.
  parameters.know({"output_path", "visualize_imu_forward", "visualize_camera_size"});
  if (warnings != nullptr) {
    *warnings = remarks;
    for (const std::string& warning : parameters.warnings()) warnings->push_back(warning);
  }
  return options;
}

Pipeline::Pipeline(const PipelineOptions& options)
    : tracker_(options.cameras, {options.estimator.T_bc}, options.tracker, options.mask),
      estimator_(options.estimator),
      pose_graph_(makePoseGraph(options)),
      refines_loops_(options.loops.options.refines_in_window),
      recent_images_(kRecentImages),
      pictures_(makePictures(options.loops)),
      gyroscope_(options.estimator.td) {
  if (!options.accel_topic.empty()) joiner_.emplace();
  if (options.map.empty()) return;
  if (!pose_graph_) throw InputError(options.map + ": a map needs loop closing, which is off");
  loaded_map_ = pose_graph_->load(options.map, pictures_ ? &*pictures_ : nullptr);
}

std::size_t Pipeline::saveMap(const std::string& path) {
  if (!pose_graph_) throw InputError(path + ": a map needs loop closing, which is off");
  pose_graph_->waitUntilIdle();
  return pose_graph_->save(path, pictures_ ? &*pictures_ : nullptr);
}

void Pipeline::addImu(const ImuSample& sample) {
  gyroscope_.add(sample);
  if (!joiner_) return estimator_.addImu(sample);
  joiner_->addGyroscope(sample.stamp, sample.angular_velocity);
  addJoinedSamples();
}

void Pipeline::addAcceleration(Stamp stamp, const Eigen::Vector3d& acceleration) {
  if (!joiner_) return;
  joiner_->addAccelerometer(stamp, acceleration);
  addJoinedSamples();
}

void Pipeline::addJoinedSamples() {
  while (const std::optional<ImuSample> sample = joiner_->next()) estimator_.addImu(*sample);
}

std::vector<Event> Pipeline::takeInputEvents() {
  std::vector<Event> events = estimator_.takeInputEvents();
  if (joiner_) append(&events, joiner_->takeEvents());
  return events;
}

void Pipeline::addImage(Stamp stamp, const cv::Mat& image) {
  while (!images_.empty() && images_.back().stamp > stamp + kJump) images_.pop_back();
  images_.push_back({stamp, image});
  estimator_.addImageStamp(stamp);
  // More wait only where their samples never come.
  if (images_.size() > kMaxWaiting) images_.pop_front();
}

bool Pipeline::isReady(const WaitingImage& image) const {
  return finished_ || gyroscope_.reaches(image.stamp);
}

std::optional<PipelineResult> Pipeline::process() {
  if (images_.empty() || !isReady(images_.front())) return std::nullopt;
  const WaitingImage image = std::move(images_.front());
  images_.pop_front();
  PipelineResult result;
  result.stamp = image.stamp;
  result.image = image.image;
  track(image, &result);
  estimate(&result);
  return result;
}

void Pipeline::track(const WaitingImage& image, PipelineResult* result) {
  const StopWatch watch;
  feature_tracker::FeatureTrackerResult tracked =
      tracker_.track({image.image}, image.stamp, gyroscope_.takeUntil(image.stamp));
  result->durations.emplace_back("tracker", watch.elapsed());
  result->tracker = tracked.statistics;
  append(&result->events, tracked.events);
  if (!tracked.frame) return;
  estimator_.addFrame(*tracked.frame);
  result->frame = std::move(tracked.frame);
  if (pose_graph_) recent_images_.add(image.stamp, image.image);
}

void Pipeline::estimate(PipelineResult* result) {
  Duration estimating, closing;
  while (true) {
    const StopWatch watch;
    std::optional<estimator::EstimatorResult> estimate = estimator_.process();
    add(watch.elapsed(), &estimating);
    if (!estimate) break;
    append(&result->events, estimate->events);
    if (pose_graph_) {
      const StopWatch loop_watch;
      closeLoops(*estimate, result);
      add(loop_watch.elapsed(), &closing);
    }
    result->estimates.push_back(std::move(*estimate));
  }
  if (result->estimates.empty()) return;
  result->durations.emplace_back("estimator", estimating);
  for (const estimator::EstimatorResult& estimate : result->estimates) {
    const estimator::EstimatorStatistics& s = estimate.statistics;
    addPart("estimator/solve", s.solve_seconds, result);
    addPart("estimator/marginalize", s.marginalize_seconds, result);
  }
  if (pose_graph_) result->durations.emplace_back("pose_graph", closing);
}

void Pipeline::closeLoops(const estimator::EstimatorResult& estimate, PipelineResult* result) {
  for (const LoopEdge& edge : estimate.loop_edges) {
    const pose_graph::LoopEdgeResult refined = pose_graph_->addLoopEdge(edge);
    append(&result->events, refined.events);
    addPart("pose_graph/optimize", refined.optimize_seconds, result);
  }
  for (const Keyframe& keyframe : estimate.keyframes) addKeyframe(keyframe, result);
  for (const KeyframePoseUpdate& update : estimate.left) pose_graph_->update(update);
  if (!estimate.odometry) return;
  const Pose& T_wb = estimate.odometry->state.T_wb;
  const Pose T_mw = pose_graph_->locate(estimate.odometry->sequence, T_wb).pose;
  result->corrected.push_back({estimate.odometry->stamp, T_mw * T_wb});
}

void Pipeline::addKeyframe(const Keyframe& keyframe, PipelineResult* result) {
  const cv::Mat image = recent_images_.find(keyframe.stamp);
  const pose_graph::PoseGraphResult added = pose_graph_->addKeyframe(keyframe, image);
  if (pictures_ && added.is_kept && !image.empty()) pictures_->add(keyframe.id, image);
  append(&result->events, added.events);
  if (added.match && refines_loops_) estimator_.addLoopMatch(*added.match);
  addPart("pose_graph/describe", added.search.describe_seconds, result);
  addPart("pose_graph/query", added.search.query_seconds, result);
  addPart("pose_graph/verify", added.search.verify_seconds, result);
  addPart("pose_graph/optimize", added.optimize_seconds, result);
}

}  // namespace vins::pipeline
