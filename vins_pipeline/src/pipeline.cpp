#include "vins_pipeline/pipeline.h"

#include <utility>

#include "camera_model/camera_file.h"
#include "feature_tracker/mask_file.h"

namespace vins {
namespace {

constexpr Stamp kJump = 1'000'000'000;  ///< stamps that fall by more begin a new run [ns]

/// Keys that other programs read from the same file: known, and of no meaning here.
void knowKeysOfOthers(const Parameters& parameters) {
  for (const char* key :
       {"output_path", "loop_closure", "load_previous_pose_graph", "fast_relocalization",
        "pose_graph_save_path", "save_image", "visualize_imu_forward", "visualize_camera_size"}) {
    parameters.textOr(key, "");
  }
}

void append(std::vector<Event>* all, const std::vector<Event>& events) {
  all->insert(all->end(), events.begin(), events.end());
}

/// A part of a stage, where it has worked at all.
void addPart(const char* stage, double seconds, PipelineResult* result) {
  if (seconds > 0.0) result->durations.emplace_back(stage, Duration{seconds, 0.0});
}

}  // namespace

PipelineOptions readPipelineOptions(const std::string& path, std::vector<std::string>* warnings) {
  const Parameters parameters = Parameters::load(path);
  PipelineOptions options;
  options.cameras = {readCamera(parameters)};
  options.tracker = readFeatureTrackerOptions(parameters);
  options.estimator = readEstimatorOptions(parameters);
  options.mask = readMaskFile(options.tracker.mask_file, options.cameras[0]->imageSize());
  options.imu_topic = parameters.textOr("imu_topic", options.imu_topic);
  options.image_topics[0] = parameters.textOr("image_topic", options.image_topics[0]);
  knowKeysOfOthers(parameters);
  if (warnings != nullptr) *warnings = parameters.warnings();
  return options;
}

Pipeline::Pipeline(const PipelineOptions& options)
    : tracker_(options.cameras, {options.estimator.T_bc}, options.tracker, options.mask),
      estimator_(options.estimator),
      offset_(toNanoseconds(options.estimator.td)) {}

void Pipeline::addImu(const ImuSample& sample) {
  // A recording that has been started again: samples of its first run would block the way.
  if (newest_imu_ && sample.stamp < *newest_imu_ - kJump) samples_.clear();
  samples_.push_back(sample);
  newest_imu_ = sample.stamp;
  estimator_.addImu(sample);
}

void Pipeline::addImage(Stamp stamp, const cv::Mat& image) {
  while (!images_.empty() && images_.back().stamp > stamp + kJump) images_.pop_back();
  images_.push_back({stamp, image});
}

bool Pipeline::isReady(const WaitingImage& image) const {
  if (finished_) return true;
  return newest_imu_ && *newest_imu_ >= image.stamp + offset_;
}

std::optional<PipelineResult> Pipeline::process() {
  if (images_.empty() || !isReady(images_.front())) return std::nullopt;
  const WaitingImage image = std::move(images_.front());
  images_.pop_front();
  PipelineResult result;
  result.stamp = image.stamp;
  track(image, &result);
  estimate(&result);
  return result;
}

std::vector<ImuSample> Pipeline::samplesUpTo(Stamp stamp) {
  std::vector<ImuSample> samples;
  while (!samples_.empty() && samples_.front().stamp - offset_ <= stamp) {
    samples.push_back(samples_.front());
    samples.back().stamp -= offset_;
    samples_.pop_front();
  }
  return samples;
}

void Pipeline::track(const WaitingImage& image, PipelineResult* result) {
  const StopWatch watch;
  const FeatureTrackerResult tracked =
      tracker_.track({image.image}, image.stamp, samplesUpTo(image.stamp));
  result->durations.emplace_back("tracker", watch.elapsed());
  result->tracker = tracked.statistics;
  append(&result->events, tracked.events);
  if (!tracked.frame) return;
  result->features = static_cast<int>(tracked.frame->observations.size());
  estimator_.addFrame(*tracked.frame);
}

void Pipeline::estimate(PipelineResult* result) {
  const StopWatch watch;
  while (auto estimate = estimator_.process()) {
    append(&result->events, estimate->events);
    result->estimates.push_back(std::move(*estimate));
  }
  if (result->estimates.empty()) return;
  result->durations.emplace_back("estimator", watch.elapsed());
  for (const EstimatorResult& estimate : result->estimates) {
    const EstimatorStatistics& s = estimate.statistics;
    addPart("estimator/solve", s.solve_seconds, result);
    addPart("estimator/marginalize", s.marginalize_seconds, result);
  }
}

}  // namespace vins
