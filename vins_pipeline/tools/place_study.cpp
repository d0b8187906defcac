#include "place_study.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <variant>

#include "vins_core/input_error.h"
#include "vins_core/progress_bar.h"
#include "vins_core/so3.h"
#include "vins_core/wall_clock.h"
#include "vins_pipeline/bag_recording.h"
#include "vins_pipeline/input_account.h"

namespace vins::pipeline {
namespace {

constexpr double kLargestTruthGap = 0.2;  // [s]
// Beyond these a corner looks different, and BRIEF, which knows no scale, is not meant to match it.
constexpr double kLargestScale = 1.5;
constexpr double kLargestParallax = 0.44;  // [rad], 25 degrees

/// Runs a recording through the stages and keeps its keyframes.
class Collector {
 public:
  explicit Collector(const PipelineOptions& options)
      : pipeline_(options), size_(options.cameras.front()->imageSize()) {}

  void feed(const Record& record) {
    if (const auto* sample = std::get_if<ImuSample>(&record.data)) {
      pipeline_.addImu(*sample);
    } else if (const auto* truth = std::get_if<RecordedTruth>(&record.data)) {
      const bool is_next = truth_.empty() || truth->stamp > truth_.poses().back().stamp;
      if (truth->has_rotation && is_next) truth_.append({truth->stamp, truth->T_wb});
    } else {
      addImage(std::get<RecordedImage>(record.data));
    }
    work();
  }

  /// Which images could be used, and why others could not.
  const InputAccount& inputs() const { return inputs_; }
  const std::vector<std::string>& refusals() const { return refusals_; }

  std::vector<StudiedKeyframe> finish() {
    pipeline_.finish();
    work();
    std::vector<StudiedKeyframe> studied;
    for (StudiedKeyframe& one : keyframes_) {
      const auto T_wb = truth_.interpolate(one.keyframe.stamp, kLargestTruthGap);
      if (!T_wb) continue;
      one.T_wb_true = *T_wb;
      studied.push_back(std::move(one));
    }
    return studied;
  }

 private:
  /// An image that cannot be used costs that image only.
  void addImage(const RecordedImage& image) {
    try {
      const cv::Mat pixels = image.load();
      if (pixels.cols != size_.width || pixels.rows != size_.height) {
        throw InputError("found an image of another size than the configuration's camera");
      }
      inputs_.addImage(image.stamp);
      images_[image.stamp] = pixels;
      pipeline_.addImage(image.stamp, pixels);
    } catch (const InputError& error) {
      refusals_.push_back(inputs_.refuse(image.stamp, error.what()).text);
    }
  }

  void work() {
    while (const auto result = pipeline_.process()) {
      for (const estimator::EstimatorResult& estimate : result->estimates) {
        for (const Keyframe& keyframe : estimate.keyframes) keep(keyframe);
      }
    }
    // A keyframe is handed on within a second; other images are not needed longer.
    while (!images_.empty() && toSeconds(images_.rbegin()->first - images_.begin()->first) > 5.0) {
      images_.erase(images_.begin());
    }
  }

  void keep(const Keyframe& keyframe) {
    // The image whose stamp is nearest: the estimator's may be moved by the time offset.
    auto best = images_.end();
    for (auto at = images_.begin(); at != images_.end(); ++at) {
      if (best == images_.end() ||
          std::abs(at->first - keyframe.stamp) < std::abs(best->first - keyframe.stamp)) {
        best = at;
      }
    }
    if (best != images_.end()) keyframes_.push_back({keyframe, best->second, {}});
  }

  Pipeline pipeline_;
  camera_model::ImageSize size_;
  InputAccount inputs_;
  std::vector<std::string> refusals_;
  Trajectory truth_;
  std::map<Stamp, cv::Mat> images_;
  std::vector<StudiedKeyframe> keyframes_;
};

void tellRefused(const std::vector<std::string>& reasons, const RecordingSummary& recording) {
  if (reasons.empty()) return;
  for (const std::string& reason : reasons) std::cerr << "warning: " << reason << "\n";
  std::cout << "refused: " << reasons.size() << " of " << recording.images << " images\n";
}

bool isExcluded(const std::vector<StudiedKeyframe>& keyframes, std::size_t query, std::size_t old,
                const pose_graph::LoopDetectorOptions& options) {
  const double seconds = toSeconds(keyframes[query].keyframe.stamp - keyframes[old].keyframe.stamp);
  return query - old <= static_cast<std::size_t>(options.excluded_keyframes) ||
         seconds < options.excluded_seconds;
}

StudiedQuery askDatabase(const std::vector<StudiedKeyframe>& keyframes,
                         const std::vector<pose_graph::DescribedView>& described, std::size_t query,
                         const pose_graph::PlaceDatabase& database,
                         const camera_model::Camera& camera, const PlaceStudyOptions& options) {
  StudiedQuery result;
  result.query = query;
  std::size_t end = 0;
  while (end < query && !isExcluded(keyframes, query, end, options.detector)) ++end;
  for (std::size_t old = 0; old < end && !result.can_be_found; ++old) {
    result.can_be_found =
        overlapOf(keyframes[query], keyframes[old], camera) >= options.needed_overlap;
  }
  const auto best = database.query(described[query].bag, 1, static_cast<std::int64_t>(end));
  if (best.empty()) return result;
  result.old = static_cast<std::size_t>(best[0].id);
  result.score = best[0].score;
  const double expected = pose_graph::bagScore(described[query].bag, described[query - 1].bag);
  result.normalized_score = result.score / std::max(expected, options.detector.min_score);
  result.overlap = overlapOf(keyframes[query], keyframes[*result.old], camera);
  return result;
}

StudiedLoop compare(const std::vector<StudiedKeyframe>& keyframes,
                    const std::vector<pose_graph::DescribedView>& described, std::size_t query,
                    const pose_graph::LoopCandidate& candidate,
                    const pose_graph::LoopVerifier& verifier, const camera_model::Camera& camera) {
  StudiedLoop loop;
  loop.query = query;
  loop.old = static_cast<std::size_t>(candidate.id);
  loop.score = candidate.score;
  loop.verification = verifier.verify(described[query].view, described[loop.old].view);
  loop.overlap = overlapOf(keyframes[query], keyframes[loop.old], camera);
  const Pose truth = keyframes[loop.old].T_wb_true.inverse() * keyframes[query].T_wb_true;
  const Pose error = truth.inverse() * loop.verification.T_old_query;
  loop.position_error = error.position.norm();
  loop.rotation_error = so3::log(error.rotation).norm();
  return loop;
}

}  // namespace

std::vector<StudiedKeyframe> collectKeyframes(const PipelineOptions& options,
                                              const std::string& recording, double start,
                                              std::optional<double> duration) {
  RecordingSelection selection;
  selection.imu_topic = options.imu_topic;
  selection.image_topics = {options.image_topics.front()};
  selection.start = start;
  selection.duration = duration;
  const auto opened = openRecording({recording}, selection);
  Collector collector(options);
  const Stamp begin = opened->summary().begin, end = opened->summary().end;
  const auto milliseconds = [begin](Stamp stamp) {
    return static_cast<std::size_t>(std::max<Stamp>(0, stamp - begin) / 1'000'000);
  };
  auto bar = ProgressBar::onStandardError("odometry", milliseconds(end));
  while (const auto record = opened->next()) {
    collector.feed(*record);
    bar.update(milliseconds(record->arrival));
  }
  collector.inputs().requireImages();
  auto keyframes = collector.finish();
  bar.finish(std::to_string(keyframes.size()) + " keyframes");
  tellRefused(collector.refusals(), opened->summary());
  if (keyframes.empty()) throw InputError(recording + ": gave no keyframes with ground truth");
  return keyframes;
}

double overlapOf(const StudiedKeyframe& query, const StudiedKeyframe& old,
                 const camera_model::Camera& camera) {
  if (query.keyframe.points.empty()) return 0.0;
  const Pose T_cw_query = (query.keyframe.T_wb * query.keyframe.T_bc).inverse();
  const Pose T_old_query =
      (old.T_wb_true * old.keyframe.T_bc).inverse() * (query.T_wb_true * query.keyframe.T_bc);
  int seen = 0;
  for (const KeyframePoint& point : query.keyframe.points) {
    const Eigen::Vector3d p_query = T_cw_query * point.position_w;
    const Eigen::Vector3d p_old = T_old_query * p_query;
    const auto pixel = camera.project(p_old);
    if (!pixel || !camera.contains(*pixel)) continue;
    const double scale = p_old.norm() / p_query.norm();
    const double cosine = p_old.normalized().dot(T_old_query.rotation * p_query.normalized());
    const bool is_alike =
        scale < kLargestScale && scale > 1.0 / kLargestScale && cosine > std::cos(kLargestParallax);
    seen += is_alike ? 1 : 0;
  }
  return static_cast<double>(seen) / static_cast<double>(query.keyframe.points.size());
}

PlaceStudy studyPlaces(const std::vector<StudiedKeyframe>& keyframes,
                       const camera_model::Camera& camera, const pose_graph::Vocabulary& vocabulary,
                       const pose_graph::BriefPattern& pattern, const PlaceStudyOptions& options) {
  const pose_graph::ViewDescriber describer(camera, vocabulary, pattern, options.view);
  const pose_graph::LoopVerifier verifier(options.verifier);
  pose_graph::LoopDetector detector(vocabulary.wordCount(), options.detector);
  PlaceStudy study;
  std::vector<pose_graph::DescribedView> described;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    WallClock clock;
    // The places in the list stand for the ids.
    Keyframe keyframe = keyframes[i].keyframe;
    keyframe.id = static_cast<std::int64_t>(i);
    described.push_back(describer.describe(keyframe, keyframes[i].image));
    study.describe_ms += 1e3 * clock.lap() / static_cast<double>(keyframes.size());
    study.largest_view = std::max(study.largest_view, described[i].view.memory());
    if (i > 0) {
      study.queries.push_back(
          askDatabase(keyframes, described, i, detector.database(), camera, options));
    }
    clock.lap();
    const auto candidates = detector.detect(keyframe.id, keyframe.stamp, described[i].bag);
    study.detect_ms += 1e3 * clock.lap() / static_cast<double>(keyframes.size());
    for (const pose_graph::LoopCandidate& candidate : candidates) {
      clock.lap();
      study.loops.push_back(compare(keyframes, described, i, candidate, verifier, camera));
      const double passed = 1e3 * clock.lap();
      study.verify_ms += passed;
      study.verify_worst_ms = std::max(study.verify_worst_ms, passed);
      if (study.loops.back().verification.isAccepted()) break;
    }
  }
  study.verify_ms /= std::max<double>(1.0, static_cast<double>(study.loops.size()));
  for (pose_graph::DescribedView& one : described) study.views.push_back(std::move(one.view));
  return study;
}

std::vector<CurvePoint> precisionRecall(const PlaceStudy& study, const PlaceStudyOptions& options) {
  std::vector<const StudiedQuery*> answers;
  int can_be_found = 0;
  for (const StudiedQuery& query : study.queries) {
    can_be_found += query.can_be_found ? 1 : 0;
    if (query.old) answers.push_back(&query);
  }
  std::stable_sort(answers.begin(), answers.end(), [](const auto* a, const auto* b) {
    return a->normalized_score > b->normalized_score;
  });
  std::vector<CurvePoint> curve;
  CurvePoint point;
  int right_ones_to_find = 0;
  for (const StudiedQuery* answer : answers) {
    const bool is_right = answer->overlap >= options.found_overlap;
    ++point.answers;
    point.right += is_right ? 1 : 0;
    right_ones_to_find += is_right && answer->can_be_found ? 1 : 0;
    point.threshold = answer->normalized_score;
    point.precision = static_cast<double>(point.right) / point.answers;
    point.recall = can_be_found > 0 ? static_cast<double>(right_ones_to_find) / can_be_found : 0.0;
    curve.push_back(point);
  }
  return curve;
}

double recallWithoutError(const std::vector<CurvePoint>& curve) {
  double recall = 0.0;
  for (const CurvePoint& point : curve) {
    if (point.right == point.answers) recall = std::max(recall, point.recall);
  }
  return recall;
}

}  // namespace vins::pipeline
