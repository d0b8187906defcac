#include "pose_graph/loop/loop_verifier.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;

/// Sum of squared errors, each at most the threshold's: less is better.
class TruncatedScore {
 public:
  explicit TruncatedScore(double threshold) : limit_(threshold * threshold) {}
  void add(double squared_error) { sum_ += std::min(limit_, squared_error); }
  double sum() const { return sum_; }

 private:
  double limit_;
  double sum_ = 0.0;
};

/// Squared chord between a direction and where the point is put.
double squaredError(const LevelPoint& seen, const YawTranslation& pose) {
  return ((pose * seen.point).normalized() - seen.direction).squaredNorm();
}

template <std::size_t Size>
std::array<std::size_t, Size> drawSample(std::size_t count, std::mt19937_64* random) {
  std::array<std::size_t, Size> sample{};
  for (std::size_t i = 0; i < Size;) {
    sample[i] = static_cast<std::size_t>((*random)() % count);
    if (std::find(sample.begin(), sample.begin() + i, sample[i]) == sample.begin() + i) ++i;
  }
  return sample;
}

}  // namespace

/// Two views in level frames, and what has been found so far. `left` are the matches that are still
/// believed in, by their places in result.matches.
struct LoopVerifier::Problem {
  Problem(const KeyframeView& query_view, const KeyframeView& old_view, std::uint64_t seed)
      : query(&query_view), old(&old_view), random(seed) {
    // The query's level frame is turned so that the yaw between the level frames is that between
    // the bodies.
    const double yaw = yawOf(query->R_wb * old->R_wb.conjugate());
    R_lq = yawRotation(-yaw) * query->R_wb;
    R_lo = old->R_wb;
  }

  void prepare(const std::vector<ViewMatch>& matches) {
    for (const ViewMatch& match : matches) {
      const ViewFeature& from = query->features[match.query];
      const Vector3d bearing_q = from.bearing.cast<double>().normalized();
      const Vector3d bearing_o = old->features[match.old].bearing.cast<double>().normalized();
      const Vector3d point_b = query->points[from.point].position_b;
      bearings.push_back(
          {R_lq * (query->T_bc.rotation * bearing_q), R_lo * (old->T_bc.rotation * bearing_o)});
      points.push_back({R_lq * point_b, bearings.back().old});
      seen.push_back({point_b, bearing_o});
      left.push_back(left.size());
    }
  }

  template <typename IsGood>
  void keep(const IsGood& is_good) {
    left.erase(std::remove_if(left.begin(), left.end(), [&](std::size_t i) { return !is_good(i); }),
               left.end());
  }

  /// Where the query's body stands in the old camera, from a pose in level frames.
  Pose cameraPose(const YawTranslation& motion) const {
    const Quaterniond R_cl = (R_lo * old->T_bc.rotation).conjugate();
    return {R_cl * yawRotation(motion.yaw) * R_lq, R_cl * motion.translation};
  }

  const KeyframeView* query;
  const KeyframeView* old;
  std::mt19937_64 random;
  Quaterniond R_lq, R_lo;
  std::vector<LevelBearings> bearings;
  std::vector<LevelPoint> points;
  std::vector<SeenPoint> seen;
  std::vector<std::size_t> left;
  Pose T_oq;  ///< query's body in the old camera's frame
  LoopVerification result;
};

void LoopVerifierOptions::validate() const {
  const char* const owner = "loop verifier";
  matching.validate();
  requireWithin(owner, "min_inliers", min_inliers, {6, 10000});
  requireWithin(owner, "epipolar_threshold", epipolar_threshold, {0.1, 100});
  requireWithin(owner, "pose_threshold", pose_threshold, {0.1, 100});
  requireWithin(owner, "refined_threshold", refined_threshold, {0.1, 100});
  requireWithin(owner, "max_yaw", max_yaw, {1, 180});
  requireWithin(owner, "max_translation", max_translation, {0.01, 1e6});
  requireWithin(owner, "max_tilt", max_tilt, {0.1, 180});
  requireWithin(owner, "epipolar_samples", epipolar_samples, {1, 1e6});
  requireWithin(owner, "pose_samples", pose_samples, {1, 1e6});
}

const char* toString(LoopStatus status) {
  switch (status) {
    case LoopStatus::kAccepted:
      return "accepted";
    case LoopStatus::kFewMatches:
      return "few matches";
    case LoopStatus::kFewEpipolarInliers:
      return "few epipolar inliers";
    case LoopStatus::kFewPoseInliers:
      return "few pose inliers";
    case LoopStatus::kTilted:
      return "tilted";
    case LoopStatus::kTurnedFar:
      return "turned far";
    case LoopStatus::kFarAway:
      return "far away";
    case LoopStatus::kAgainstOdometry:
      return "against odometry";
  }
  return "unknown";
}

std::string LoopVerification::describe() const {
  std::ostringstream text;
  text << "loop " << query_id << " -> " << old_id << ": " << toString(status) << ", "
       << matches.size() << " matches, " << epipolar_inliers << " epipolar, " << pose_inliers
       << " pose inliers";
  if (pose_inliers > 0) {
    text << std::fixed << std::setprecision(1) << ", yaw " << yaw / kDegree << " deg, tilt "
         << tilt / kDegree << " deg, " << std::setprecision(2) << distance << " m";
  }
  return text.str();
}

LoopVerifier::LoopVerifier(const LoopVerifierOptions& options) : options_(options) {
  options_.validate();
}

void LoopVerifier::judgeByBearings(Problem* problem) const {
  const double threshold = options_.epipolar_threshold * problem->old->pixel_angle;
  const auto& bearings = problem->bearings;
  YawDirection best;
  double best_sum = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options_.epipolar_samples; ++i) {
    const auto sample = drawSample<3>(bearings.size(), &problem->random);
    for (const YawDirection& motion :
         solveThreeBearings({bearings[sample[0]], bearings[sample[1]], bearings[sample[2]]},
                            options_.max_yaw * kDegree)) {
      TruncatedScore score(threshold);
      for (const LevelBearings& pair : bearings) {
        const double error = epipolarError(pair, motion);
        score.add(error * error);
      }
      if (score.sum() >= best_sum) continue;
      best_sum = score.sum();
      best = motion;
    }
  }
  problem->keep([&](std::size_t i) { return epipolarError(bearings[i], best) <= threshold; });
  problem->result.epipolar_inliers = static_cast<int>(problem->left.size());
}

void LoopVerifier::judgeByPoints(Problem* problem) const {
  const double threshold = options_.pose_threshold * problem->old->pixel_angle;
  const auto& points = problem->points;
  const auto& left = problem->left;
  YawTranslation best;
  double best_sum = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options_.pose_samples; ++i) {
    const auto sample = drawSample<2>(left.size(), &problem->random);
    for (const YawTranslation& pose :
         solveTwoPoints(points[left[sample[0]]], points[left[sample[1]]])) {
      TruncatedScore score(threshold);
      for (const std::size_t match : left) score.add(squaredError(points[match], pose));
      if (score.sum() >= best_sum) continue;
      best_sum = score.sum();
      best = pose;
    }
  }
  problem->keep(
      [&](std::size_t i) { return squaredError(points[i], best) <= threshold * threshold; });
  problem->T_oq = problem->cameraPose(best);
  problem->result.pose_inliers = static_cast<int>(problem->left.size());
}

bool LoopVerifier::refine(Problem* problem) const {
  const double threshold = options_.refined_threshold * problem->old->pixel_angle;
  std::vector<SeenPoint> seen;
  for (const std::size_t i : problem->left) seen.push_back(problem->seen[i]);
  if (!refinePose(seen, 0.5 * threshold, &problem->T_oq)) return false;
  problem->keep([&](std::size_t i) {
    return bearingError(problem->seen[i], problem->T_oq).norm() <= threshold;
  });
  problem->result.pose_inliers = static_cast<int>(problem->left.size());
  return true;
}

LoopStatus LoopVerifier::judgePose(Problem* problem) const {
  LoopVerification& result = problem->result;
  result.T_old_query = problem->old->T_bc * problem->T_oq;
  const Quaterniond R_level =
      problem->R_lo * result.T_old_query.rotation * problem->R_lq.conjugate();
  const Vector3d up = R_level * Vector3d::UnitZ();
  result.tilt = std::atan2(up.head<2>().norm(), up.z());
  result.yaw = yawOf(R_level);
  result.distance = result.T_old_query.position.norm();
  if (result.tilt > options_.max_tilt * kDegree) return LoopStatus::kTilted;
  if (std::abs(result.yaw) > options_.max_yaw * kDegree) return LoopStatus::kTurnedFar;
  if (result.distance > options_.max_translation) return LoopStatus::kFarAway;
  return LoopStatus::kAccepted;
}

LoopStatus LoopVerifier::judge(Problem* problem) const {
  LoopVerification& result = problem->result;
  const auto isFew = [&] {
    // A scene with little to see has few matches, of which chance agrees on a third.
    const auto needed = static_cast<std::size_t>(options_.min_inliers);
    const std::size_t count = problem->left.size();
    const bool shows_little = problem->query->points.size() < 4 * needed;
    const bool are_most = count >= needed / 2 && 2 * count > result.matches.size();
    return count < needed && !(shows_little && are_most);
  };
  result.matches = matchViews(*problem->query, *problem->old, options_.matching);
  problem->prepare(result.matches);
  if (isFew()) return LoopStatus::kFewMatches;
  judgeByBearings(problem);
  if (isFew()) return LoopStatus::kFewEpipolarInliers;
  judgeByPoints(problem);
  if (isFew() || !refine(problem) || isFew()) return LoopStatus::kFewPoseInliers;
  return judgePose(problem);
}

LoopVerification LoopVerifier::verify(const KeyframeView& query, const KeyframeView& old) const {
  Problem problem(query, old, options_.seed);
  problem.result.query_id = query.id;
  problem.result.old_id = old.id;
  const LoopStatus status = judge(&problem);
  LoopVerification& result = problem.result;
  result.status = status;
  result.is_inlier.assign(result.matches.size(), 0);
  for (const std::size_t i : problem.left) {
    result.is_inlier[i] = 1;
    if (status != LoopStatus::kAccepted) continue;
    const ViewFeature& feature = query.features[result.matches[i].query];
    result.features.push_back({query.points[feature.point].id, problem.seen[i].bearing_o});
  }
  return std::move(problem.result);
}

}  // namespace vins::pose_graph
