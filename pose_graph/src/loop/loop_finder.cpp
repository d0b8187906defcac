#include "pose_graph/loop/loop_finder.h"

#include <utility>

#include "vins_core/option_check.h"
#include "vins_core/wall_clock.h"

namespace vins::pose_graph {

void LoopFinderOptions::validate() const {
  view.validate();
  detector.validate();
  verifier.validate();
  requireWithin("loop finder", "min_interval", min_interval, {0.0, 1e3});
}

const LoopVerification* LoopSearch::accepted() const {
  if (checked.empty() || !checked.back().verification.isAccepted()) return nullptr;
  return &checked.back().verification;
}

LoopFinder::LoopFinder(std::shared_ptr<const camera_model::Camera> camera, const PlaceModel& places,
                       const LoopFinderOptions& options)
    : camera_(std::move(camera)),
      places_(places),
      options_(options),
      describer_(*camera_, *places_.vocabulary, *places_.pattern, options.view),
      detector_(places_.vocabulary->wordCount(), options.detector),
      verifier_(options.verifier) {
  options_.validate();
}

LoopSearch LoopFinder::addKeyframe(const Keyframe& keyframe, const cv::Mat& image,
                                   const Gate& gate) {
  WallClock clock;
  DescribedView described = describer_.describe(keyframe, image);
  const double describe_seconds = clock.lap();
  LoopSearch search = addDescribed(keyframe, std::move(described), gate);
  search.describe_seconds = describe_seconds;
  return search;
}

LoopSearch LoopFinder::addDescribed(const Keyframe& keyframe, DescribedView described,
                                    const Gate& gate) {
  LoopSearch search;
  WallClock clock;
  const std::vector<LoopCandidate> candidates =
      detector_.detect(keyframe.id, keyframe.stamp, described.bag);
  search.query_seconds = clock.lap();
  if (!isTooSoon(keyframe)) {
    verify(described.view, candidates, gate, &search);
    search.verify_seconds = clock.lap();
  }
  if (search.accepted() != nullptr) last_loop_ = {keyframe.sequence, keyframe.stamp};
  remember(std::move(described.view));
  return search;
}

void LoopFinder::addStored(KeyframeView view) {
  detector_.add(view.id, describer_.findWords(&view));
  remember(std::move(view));
}

void LoopFinder::remember(KeyframeView view) {
  view_bytes_ += view.memory();
  const std::int64_t id = view.id;
  views_.emplace(id, std::move(view));
}

bool LoopFinder::isTooSoon(const Keyframe& keyframe) const {
  return last_loop_ && last_loop_->sequence == keyframe.sequence &&
         toSeconds(keyframe.stamp - last_loop_->stamp) < options_.min_interval;
}

void LoopFinder::verify(const KeyframeView& query, const std::vector<LoopCandidate>& candidates,
                        const Gate& gate, LoopSearch* search) const {
  for (const LoopCandidate& candidate : candidates) {
    search->checked.push_back({candidate.score, verifier_.verify(query, views_.at(candidate.id))});
    LoopVerification& verification = search->checked.back().verification;
    if (!verification.isAccepted()) continue;
    if (!gate || gate(verification)) return;
    verification.status = LoopStatus::kAgainstOdometry;
  }
}

bool LoopFinder::remove(std::int64_t id) {
  const auto found = views_.find(id);
  if (found == views_.end()) return false;
  view_bytes_ -= found->second.memory();
  views_.erase(found);
  detector_.remove(id);
  return true;
}

const KeyframeView* LoopFinder::view(std::int64_t id) const {
  const auto found = views_.find(id);
  return found == views_.end() ? nullptr : &found->second;
}

}  // namespace vins::pose_graph
