#include "vins_estimator/health/rig_check.h"

#include <algorithm>

#include "rig_event.h"

namespace vins::estimator {

void RigCheck::begin(Stamp stamp) { not_before_ = stamp + toNanoseconds(options_.settling); }

void RigCheck::clear() {
  scores_.clear();
  not_before_.reset();
  verdict_.reset();
}

std::optional<Event> RigCheck::addScore(Stamp newest, const RigScore& score) {
  not_before_ = newest;
  scores_.push_back(score);
  if (scores_.size() > options_.max_windows) scores_.pop_front();
  const std::optional<RigExplanation> found = judge();
  const std::optional<RigPart> before = verdict_;
  verdict_ = found ? std::optional<RigPart>(found->part) : std::nullopt;
  if (verdict_ == before) return std::nullopt;
  return found ? rigEvent(newest, *found, scores_.size()) : rigAgreesEvent(newest);
}

const RigErrorSizes& RigCheck::sizesOf(RigPart part) const {
  switch (part) {
    case RigPart::kTranslation:
      return options_.translation;
    case RigPart::kRotation:
      return options_.rotation;
    case RigPart::kTimeOffset:
      return options_.time_offset;
    case RigPart::kReadout:
      return options_.readout;
    case RigPart::kFocalLength:
      break;
  }
  return options_.focal_length;
}

bool RigCheck::isConvincing(const RigExplanation& explanation) const {
  const RigErrorSizes& sizes = sizesOf(explanation.part);
  const double least_gain = options_.min_deviations * options_.min_deviations * explanation.scatter;
  return explanation.size >= sizes.least && explanation.size <= sizes.most &&
         explanation.gain >= least_gain && explanation.share >= options_.min_share;
}

/// A verdict stands until it is clearly refuted, so that it does not come and go at its limits.
bool RigCheck::stillHolds(const RigExplanation& explanation) const {
  return explanation.size >= 0.5 * sizesOf(explanation.part).least &&
         explanation.share >= 0.5 * options_.min_share;
}

/// Of all suspects, the one that explains most first.
std::vector<RigExplanation> RigCheck::explainAll() const {
  std::vector<RigExplanation> explanations;
  for (const RigPart part : options_.suspects) {
    explanations.push_back(explainBy(part, options_.estimated, scores_));
  }
  std::sort(explanations.begin(), explanations.end(),
            [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return explanations;
}

std::optional<RigExplanation> RigCheck::judge() const {
  if (scores_.size() < options_.min_windows || options_.suspects.empty()) return std::nullopt;
  const std::vector<RigExplanation> explanations = explainAll();
  const RigExplanation& best = explanations.front();
  const bool leads =
      explanations.size() < 2 || best.gain >= options_.min_lead * explanations[1].gain;
  if (leads && isConvincing(best)) return best;
  for (const RigExplanation& explanation : explanations) {
    if (verdict_ == explanation.part && stillHolds(explanation)) return explanation;
  }
  return std::nullopt;
}

}  // namespace vins::estimator
