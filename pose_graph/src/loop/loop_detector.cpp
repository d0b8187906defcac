#include "pose_graph/loop/loop_detector.h"

#include <algorithm>
#include <utility>

#include "vins_core/option_check.h"

namespace vins::pose_graph {

void LoopDetectorOptions::validate() const {
  const char* const owner = "loop detector";
  requireWithin(owner, "excluded_keyframes", excluded_keyframes, {0, 1e6});
  requireWithin(owner, "excluded_seconds", excluded_seconds, {0, 1e6});
  requireWithin(owner, "query_results", query_results, {1, 1e6});
  requireWithin(owner, "min_normalized_score", min_normalized_score, {0, 10});
  requireWithin(owner, "min_score", min_score, {0, 1});
  requireWithin(owner, "island_gap", island_gap, {0, 1000});
  requireWithin(owner, "consistent_keyframes", consistent_keyframes, {0, 100});
  requireWithin(owner, "max_candidates", max_candidates, {1, 100});
}

LoopDetector::LoopDetector(std::size_t word_count, const LoopDetectorOptions& options)
    : options_(options), database_(word_count) {
  options_.validate();
}

std::vector<LoopCandidate> LoopDetector::detect(std::int64_t id, Stamp stamp,
                                                const BagOfWords& bag) {
  if (!recent_.empty() && stamp <= recent_.back().stamp) {
    recent_.clear();
    last_bag_.clear();
    last_islands_.clear();
  }
  const std::int64_t first_excluded = firstExcluded(id, stamp);
  std::vector<LoopCandidate> candidates = choose(islandsOf(bag, first_excluded));
  remember(id, stamp, bag);
  return candidates;
}

std::int64_t LoopDetector::firstExcluded(std::int64_t id, Stamp stamp) const {
  std::int64_t first = id;
  const std::size_t excluded = static_cast<std::size_t>(options_.excluded_keyframes);
  for (std::size_t i = 0; i < recent_.size(); ++i) {
    const Recent& entry = recent_[recent_.size() - 1 - i];
    const bool is_recent = toSeconds(stamp - entry.stamp) < options_.excluded_seconds;
    if (i < excluded || is_recent) first = std::min(first, entry.id);
  }
  return first;
}

std::vector<LoopDetector::Island> LoopDetector::islandsOf(const BagOfWords& bag,
                                                          std::int64_t ids_below) const {
  // Where the keyframe before has nothing in common, after a turn or a blackout, it says nothing of
  // what is to be expected: then the lowest score that means something stands for it.
  const double expected = std::max(bagScore(bag, last_bag_), options_.min_score);
  const std::vector<std::int64_t> ids = database_.ids();
  std::vector<std::pair<std::size_t, LoopCandidate>> entries;
  for (const PlaceScore& place :
       database_.query(bag, static_cast<std::size_t>(options_.query_results), ids_below)) {
    const double normalized = place.score / expected;
    if (place.score < options_.min_score || normalized < options_.min_normalized_score) continue;
    const auto at = std::lower_bound(ids.begin(), ids.end(), place.id) - ids.begin();
    entries.push_back({static_cast<std::size_t>(at), {place.id, place.score, normalized, 0.0, 0}});
  }
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Island> islands;
  for (const auto& [at, entry] : entries) {
    const auto gap = static_cast<std::size_t>(options_.island_gap);
    if (islands.empty() || at > islands.back().last + gap) {
      islands.push_back({at, at, entry.id, entry.id, entry});
    }
    Island& island = islands.back();
    const double sum = island.best.island_score + entry.normalized_score;
    if (entry.score > island.best.score) island.best = entry;
    island.best.island_score = sum;
    island.last = at;
    island.last_id = entry.id;
  }
  return islands;
}

std::vector<LoopCandidate> LoopDetector::choose(std::vector<Island> islands) {
  const std::vector<std::int64_t> ids = database_.ids();
  const auto gap = options_.island_gap;
  // Islands of two keyframes are the same where they touch or nearly so. Ids are compared, because
  // entries may have been removed between.
  const auto reach = [&](std::int64_t id, int steps) {
    const auto at = std::lower_bound(ids.begin(), ids.end(), id) - ids.begin() + steps;
    return ids.empty() ? id
                       : ids[std::clamp<std::ptrdiff_t>(at, 0, std::ptrdiff_t(ids.size()) - 1)];
  };
  std::vector<LoopCandidate> candidates;
  for (Island& island : islands) {
    for (const Island& before : last_islands_) {
      const bool touches = before.last_id >= reach(island.first_id, -gap) &&
                           before.first_id <= reach(island.last_id, gap);
      if (touches) {
        island.best.consistent = std::max(island.best.consistent, before.best.consistent + 1);
      }
    }
    if (island.best.consistent >= options_.consistent_keyframes) candidates.push_back(island.best);
  }
  last_islands_ = std::move(islands);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.island_score > b.island_score; });
  const auto most = static_cast<std::size_t>(options_.max_candidates);
  if (candidates.size() > most) candidates.resize(most);
  return candidates;
}

void LoopDetector::remember(std::int64_t id, Stamp stamp, const BagOfWords& bag) {
  database_.add(id, bag);
  last_bag_ = bag;
  recent_.push_back({id, stamp});
  const auto is_old = [&](const Recent& entry) {
    return recent_.size() > static_cast<std::size_t>(options_.excluded_keyframes) + 1 &&
           toSeconds(stamp - entry.stamp) > options_.excluded_seconds;
  };
  while (is_old(recent_.front())) recent_.pop_front();
}

}  // namespace vins::pose_graph
