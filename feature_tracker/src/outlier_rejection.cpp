#include "feature_tracker/outlier_rejection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion_fit.h"

namespace vins::feature_tracker {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t kFewestPairs = 6;
constexpr std::size_t kSampleSize = 5;     // pairs that determine a motion
constexpr std::size_t kCandidates = 5;     // motions of samples that are fitted to all pairs
constexpr int kFirstSteps = 2;             // of the fit to all pairs, for all candidates
constexpr int kLastSteps = 4;              // and for the best of them
constexpr double kFinest = 0.03;           // standard deviation of the best tracks [px]
constexpr double kScale = 2.0;             // standard deviations where a pair begins to count less
constexpr double kSigmas = 5.0;            // of good pairs' distances: what is further is wrong
constexpr double kSigmaOfMedian = 1.4826;  // standard deviation by median, of a normal distribution
constexpr double kSharpest = 0.3;          // share of the threshold that all pairs have
constexpr double kNoMeasurement = 0.3;     // standard deviation of a guessed rotation [rad]
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double medianOf(std::vector<float>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return static_cast<double>(*middle);
}

/// Direction on which the parallaxes of two pairs agree, up to its sign.
bool directionOfTwo(const BearingPair& a, const BearingPair& b, const Quaterniond& R_21,
                    Vector3d* t_21) {
  const Vector3d normal_a = (R_21 * a.first).cross(a.second);
  const Vector3d normal_b = (R_21 * b.first).cross(b.second);
  const Vector3d direction = normal_a.cross(normal_b);
  const double length = direction.norm();
  if (!(length > 1e-12)) return false;
  *t_21 = direction / length;
  return true;
}

}  // namespace

/// Where motions are sought, and how.
struct OutlierRejection::MotionSearch {
  Quaterniond R_21;       ///< rotation that is known before
  double rotation_sigma;  ///< its standard deviation [rad]
  int steps;              ///< Gauss-Newton steps on each sample
};

struct OutlierRejection::Candidate {
  RelativeMotion motion;
  double cost;
};

OutlierRejection::OutlierRejection(const OutlierRejectionOptions& options)
    : options_(options), random_(options.seed), table_(std::make_unique<EpipolarTable>()) {}

OutlierRejection::~OutlierRejection() = default;

void OutlierRejection::drawSample(std::size_t count, std::size_t size) {
  // Not std::uniform_int_distribution: its numbers differ between standard libraries.
  sample_.clear();
  while (sample_.size() < size) {
    const std::size_t i = random_() % count;
    if (std::find(sample_.begin(), sample_.end(), i) == sample_.end()) sample_.push_back(i);
  }
}

std::vector<OutlierRejection::Candidate> OutlierRejection::propose(
    const std::vector<BearingPair>& pairs, const MotionSearch& search) {
  MotionFitOptions fit;
  fit.scale = std::numeric_limits<double>::infinity();
  fit.rotation_sigma = search.rotation_sigma;
  fit.R_prior = search.R_21;
  std::vector<Candidate> best;
  for (int i = 0; i < options_.samples; ++i) {
    drawSample(pairs.size(), kSampleSize);
    RelativeMotion motion{search.R_21, Vector3d::UnitZ()};
    if (!directionOfTwo(pairs[sample_[0]], pairs[sample_[1]], search.R_21, &motion.t_21)) continue;
    for (int step = 0; step < search.steps; ++step) stepMotion(pairs, sample_, fit, &motion);
    const double limit = best.size() < kCandidates ? kNoLimit : best.back().cost;
    const double cost = medianDistance(motion, limit);
    if (cost >= limit) continue;
    if (best.size() == kCandidates) best.pop_back();
    const auto after = std::find_if(best.begin(), best.end(),
                                    [cost](const Candidate& other) { return other.cost > cost; });
    best.insert(after, {motion, cost});
  }
  return best;
}

RelativeMotion OutlierRejection::search(const std::vector<BearingPair>& pairs,
                                        const MotionSearch& search) {
  RelativeMotion best{search.R_21, Vector3d::UnitZ()};
  double best_cost = kNoLimit;
  for (const Candidate& candidate : propose(pairs, search)) {
    const RelativeMotion motion = polish(pairs, candidate.motion, search, kFirstSteps);
    const double cost = medianDistance(motion, best_cost);
    if (cost >= best_cost) continue;
    best = motion;
    best_cost = cost;
  }
  best = polish(pairs, best, search, kLastSteps);
  faceForward(pairs, options_.threshold, &best);
  return best;
}

RelativeMotion OutlierRejection::polish(const std::vector<BearingPair>& pairs,
                                        RelativeMotion motion, const MotionSearch& search,
                                        int steps) {
  MotionFitOptions fit;
  fit.rotation_sigma = search.rotation_sigma;
  fit.R_prior = search.R_21;
  for (int step = 0; step < steps; ++step) {
    // As wide as the pairs lie now: a rotation that is off must not shut good pairs out.
    const double sigma = kSigmaOfMedian * medianDistance(motion, kNoLimit);
    fit.sigma = std::clamp(sigma, kFinest, options_.threshold);
    fit.scale = kScale * fit.sigma;
    stepMotion(pairs, {}, fit, &motion);
  }
  return motion;
}

double OutlierRejection::medianDistance(const RelativeMotion& motion, double limit) {
  table_->squaredDistances(motion, &squares_);
  // Most motions are not worth to look for the median: it is beyond the limit.
  const float squared_limit = static_cast<float>(limit * limit);
  std::size_t within = 0;
  for (const float square : squares_) within += square < squared_limit ? 1 : 0;
  if (2 * within < squares_.size()) return kNoLimit;
  return std::sqrt(medianOf(&squares_));
}

RejectionResult OutlierRejection::classify(const std::vector<BearingPair>& pairs,
                                           const RelativeMotion& motion) {
  RejectionResult result;
  result.motion = motion;
  const double sigma = kSigmaOfMedian * medianDistance(motion, kNoLimit);
  result.threshold =
      std::clamp(kSigmas * sigma, kSharpest * options_.threshold, options_.threshold);
  result.is_inlier.reserve(pairs.size());
  for (const BearingPair& pair : pairs) {
    const bool in_plane = epipolarDistance(pair, motion) <= result.threshold;
    // A little more slack: along the plane the error of the rotation adds to that of the track.
    const bool in_front = displacement(pair, motion) >= -2.0 * options_.threshold;
    const bool is_inlier = in_plane && in_front;
    result.is_inlier.push_back(is_inlier ? 1 : 0);
    result.inliers += is_inlier ? 1 : 0;
  }
  return result;
}

RejectionResult OutlierRejection::reject(const std::vector<BearingPair>& pairs,
                                         const std::optional<Quaterniond>& R_21_measured,
                                         const Quaterniond& R_21_guess) {
  if (pairs.size() < kFewestPairs) {
    RejectionResult all;
    all.is_inlier.assign(pairs.size(), 1);
    all.inliers = static_cast<int>(pairs.size());
    all.motion.R_21 = R_21_measured.value_or(R_21_guess);
    return all;
  }
  table_->assign(pairs);
  std::optional<RejectionResult> by_gyroscope;
  if (R_21_measured) {
    const MotionSearch near_measured{*R_21_measured, options_.rotation_sigma, 2};
    by_gyroscope = classify(pairs, search(pairs, near_measured));
    if (2 * by_gyroscope->inliers >= static_cast<int>(pairs.size())) return *by_gyroscope;
  }
  const Quaterniond R_fitted = fitRotation(pairs, R_21_measured.value_or(R_21_guess));
  RejectionResult by_images = classify(pairs, search(pairs, {R_fitted, kNoMeasurement, 5}));
  return by_gyroscope && by_gyroscope->inliers >= by_images.inliers ? *by_gyroscope : by_images;
}

}  // namespace vins::feature_tracker
