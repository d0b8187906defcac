#include "feature_tracker/outlier_rejection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "motion_fit.h"

namespace vins {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t kFewestPairs = 6;
constexpr double kLoose = 3.0;             // thresholds, of a motion that is not fitted yet
constexpr double kSigmas = 5.0;            // of good pairs' distances: what is further is wrong
constexpr double kSigmaOfMedian = 1.4826;  // standard deviation by median, of a normal distribution
constexpr double kSharpest = 0.3;          // share of the threshold that all pairs have
constexpr double kNoMeasurement = 0.3;     // standard deviation of a guessed rotation [rad]

double truncatedCost(const std::vector<BearingPair>& pairs, const RelativeMotion& motion,
                     double threshold, double stop_at) {
  double cost = 0.0;
  const double limit = threshold * threshold;
  for (const BearingPair& pair : pairs) {
    const double distance = epipolarDistance(pair, motion);
    cost += std::min(distance * distance, limit);
    if (cost > stop_at) break;
  }
  return cost;
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

OutlierRejection::OutlierRejection(const OutlierRejectionOptions& options)
    : options_(options), random_(options.seed) {}

void OutlierRejection::drawSample(std::size_t count, std::size_t size) {
  // Not std::uniform_int_distribution: its numbers differ between standard libraries.
  sample_.clear();
  while (sample_.size() < size) {
    const std::size_t i = random_() % count;
    if (std::find(sample_.begin(), sample_.end(), i) == sample_.end()) sample_.push_back(i);
  }
}

RelativeMotion OutlierRejection::searchByTwo(const std::vector<BearingPair>& pairs,
                                             const Quaterniond& R_21) {
  RelativeMotion best{R_21, Vector3d::UnitZ()};
  const double threshold = kLoose * options_.threshold;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options_.samples; ++i) {
    drawSample(pairs.size(), 2);
    RelativeMotion motion{R_21, Vector3d::UnitZ()};
    if (!directionOfTwo(pairs[sample_[0]], pairs[sample_[1]], R_21, &motion.t_21)) continue;
    const double cost = truncatedCost(pairs, motion, threshold, best_cost);
    if (cost >= best_cost) continue;
    best = motion;
    best_cost = cost;
  }
  return best;
}

RelativeMotion OutlierRejection::searchByFive(const std::vector<BearingPair>& pairs,
                                              const Quaterniond& R_21) {
  const Quaterniond R_fitted = fitRotation(pairs, R_21);
  RelativeMotion best = searchByTwo(pairs, R_fitted);
  double best_cost =
      truncatedCost(pairs, best, options_.threshold, std::numeric_limits<double>::infinity());
  MotionFitOptions fit;
  fit.threshold = std::numeric_limits<double>::infinity();
  fit.rotation_sigma = kNoMeasurement;
  fit.R_prior = R_fitted;
  for (int i = 0; i < options_.samples; ++i) {
    drawSample(pairs.size(), 5);
    RelativeMotion motion{R_fitted, Vector3d::UnitZ()};
    if (!directionOfTwo(pairs[sample_[0]], pairs[sample_[1]], R_fitted, &motion.t_21)) continue;
    for (int step = 0; step < 5; ++step) stepMotion(pairs, sample_, fit, &motion);
    const double cost = truncatedCost(pairs, motion, options_.threshold, best_cost);
    if (cost >= best_cost) continue;
    best = motion;
    best_cost = cost;
  }
  return best;
}

RelativeMotion OutlierRejection::polish(const std::vector<BearingPair>& pairs,
                                        RelativeMotion motion, double rotation_sigma) const {
  MotionFitOptions fit;
  fit.rotation_sigma = rotation_sigma;
  fit.R_prior = motion.R_21;
  // From loose to sharp: a rotation that is off by some pixels must not shut good pairs out.
  for (const double factor : {kLoose, kLoose, 2.0, 1.5, 1.0, 1.0}) {
    fit.threshold = factor * options_.threshold;
    stepMotion(pairs, {}, fit, &motion);
  }
  faceForward(pairs, options_.threshold, &motion);
  return motion;
}

double OutlierRejection::sharpThreshold(std::vector<double> distances) const {
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double sigma = kSigmaOfMedian * *middle;
  return std::clamp(kSigmas * sigma, kSharpest * options_.threshold, options_.threshold);
}

RejectionResult OutlierRejection::classify(const std::vector<BearingPair>& pairs,
                                           const RelativeMotion& motion) const {
  RejectionResult result;
  result.motion = motion;
  result.is_inlier.reserve(pairs.size());
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const BearingPair& pair : pairs) distances.push_back(epipolarDistance(pair, motion));
  result.threshold = sharpThreshold(distances);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool in_plane = distances[i] <= result.threshold;
    // A little more slack: along the plane the error of the rotation adds to that of the track.
    const bool in_front = displacement(pairs[i], motion) >= -2.0 * options_.threshold;
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
  std::optional<RejectionResult> by_two;
  if (R_21_measured) {
    by_two =
        classify(pairs, polish(pairs, searchByTwo(pairs, *R_21_measured), options_.rotation_sigma));
    if (2 * by_two->inliers >= static_cast<int>(pairs.size())) return *by_two;
  }
  const RelativeMotion found = searchByFive(pairs, R_21_measured.value_or(R_21_guess));
  RejectionResult by_five = classify(pairs, polish(pairs, found, kNoMeasurement));
  return by_two && by_two->inliers >= by_five.inliers ? *by_two : by_five;
}

}  // namespace vins
