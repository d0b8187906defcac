#include "vins_estimator/initialization/time_offset_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vins_core/so3.h"
#include "vins_estimator/initialization/relative_pose.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

constexpr double kLongestPair = 0.2;  // between two images that are compared [s]
constexpr double kOutlier = 0.02;     // residual of a turn whose weight is a quarter [rad]

/// Geman and McClure's loss: a turn that parallax or moving objects bend counts little.
double robustSquare(double square) {
  constexpr double kScale = kOutlier * kOutlier;
  return square * kScale / (kScale + square);
}

}  // namespace

void TimeOffsetSearch::clear() {
  angles_.clear();
  last_sample_.reset();
  last_frame_.reset();
  turns_.clear();
}

std::optional<TimeOffset> TimeOffsetSearch::addFrame(const FrameMeasurements& measurements,
                                                     const Eigen::Quaterniond& R_bc) {
  if (measurements.is_first || measurements.has_gap) clear();
  addSamples(measurements.imu);
  addTurn(measurements.frame);
  last_frame_ = measurements.frame;
  forgetOld();
  return search(R_bc);
}

void TimeOffsetSearch::addSamples(const std::vector<ImuSample>& samples) {
  for (const ImuSample& sample : samples) {
    if (!last_sample_) {
      angles_.push_back({sample.stamp, Vector3d::Zero()});
    } else if (sample.stamp > last_sample_->stamp) {
      const double dt = toSeconds(sample.stamp - last_sample_->stamp);
      const Vector3d mean = 0.5 * (sample.angular_velocity + last_sample_->angular_velocity);
      angles_.push_back({sample.stamp, angles_.back().angle + dt * mean});
    } else {
      continue;
    }
    last_sample_ = sample;
  }
}

void TimeOffsetSearch::addTurn(const FeatureFrame& frame) {
  if (!last_frame_ || toSeconds(frame.stamp - last_frame_->stamp) > kLongestPair) return;
  const std::vector<BearingPair> shared = sharedBearings(*last_frame_, frame, 1.0);
  if (static_cast<int>(shared.size()) < options_.min_shared) return;
  const Eigen::Quaterniond R_12 = fitRotation(shared, Eigen::Quaterniond::Identity());
  turns_.push_back({last_frame_->stamp, frame.stamp, so3::log(R_12)});
}

void TimeOffsetSearch::forgetOld() {
  if (!last_frame_) return;
  const Stamp oldest = last_frame_->stamp - toNanoseconds(options_.window);
  while (!turns_.empty() && turns_.front().from < oldest) turns_.pop_front();
  // Offsets of either sign need samples before the first pair.
  const Stamp needed = oldest - toNanoseconds(2.0 * options_.max_offset);
  while (angles_.size() > 2 && angles_[1].stamp < needed) angles_.pop_front();
}

/// The turns whose intervals have samples at all offsets.
std::vector<TimeOffsetSearch::CameraTurn> TimeOffsetSearch::coveredTurns() const {
  std::vector<CameraTurn> covered;
  if (angles_.empty()) return covered;
  const Stamp reach = toNanoseconds(options_.max_offset);
  for (const CameraTurn& turn : turns_) {
    const bool is_covered =
        turn.from - reach >= angles_.front().stamp && turn.to + reach <= angles_.back().stamp;
    if (is_covered) covered.push_back(turn);
  }
  return covered;
}

Vector3d TimeOffsetSearch::angleAt(Stamp stamp) const {
  const auto after =
      std::lower_bound(angles_.begin(), angles_.end(), stamp,
                       [](const Angle& angle, Stamp time) { return angle.stamp < time; });
  if (after == angles_.begin()) return angles_.front().angle;
  if (after == angles_.end()) return angles_.back().angle;
  const Angle& before = *std::prev(after);
  const double share = toSeconds(stamp - before.stamp) / toSeconds(after->stamp - before.stamp);
  return before.angle + share * (after->angle - before.angle);
}

/// Sum of squares that the offset leaves, with the best constant bias [rad^2].
double TimeOffsetSearch::misfitAt(double td, const std::vector<CameraTurn>& turns,
                                  const Eigen::Quaterniond& R_bc) const {
  const Stamp offset = toNanoseconds(td);
  std::vector<Vector3d> residuals;
  Vector3d sum = Vector3d::Zero();
  double duration = 0.0;
  for (const CameraTurn& turn : turns) {
    residuals.push_back(R_bc * turn.turn_c -
                        (angleAt(turn.to + offset) - angleAt(turn.from + offset)));
    sum += residuals.back();
    duration += toSeconds(turn.to - turn.from);
  }
  double misfit = 0.0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vector3d bias = sum * (toSeconds(turns[i].to - turns[i].from) / duration);
    misfit += robustSquare((residuals[i] - bias).squaredNorm());
  }
  return misfit;
}

std::optional<TimeOffset> TimeOffsetSearch::search(const Eigen::Quaterniond& R_bc) const {
  const std::vector<CameraTurn> turns = coveredTurns();
  if (static_cast<int>(turns.size()) < options_.min_pairs) return std::nullopt;
  const int steps = static_cast<int>(options_.max_offset / options_.step);
  std::vector<double> misfits;
  for (int i = -steps; i <= steps; ++i) {
    misfits.push_back(misfitAt(i * options_.step, turns, R_bc));
  }
  const auto least =
      static_cast<std::size_t>(std::min_element(misfits.begin(), misfits.end()) - misfits.begin());
  if (least == 0 || least + 1 == misfits.size() || !isDistinct(misfits, least, turns.size())) {
    return std::nullopt;
  }
  const double curvature = misfits[least - 1] - 2.0 * misfits[least] + misfits[least + 1];
  if (!(curvature > 0.0)) return std::nullopt;
  double total = 0.0;
  for (const CameraTurn& turn : turns) total += robustSquare(turn.turn_c.squaredNorm());
  TimeOffset found;
  found.pairs = static_cast<int>(turns.size());
  found.misfit = misfits[least] / std::max(total, 1e-12);
  const double shift = 0.5 * (misfits[least - 1] - misfits[least + 1]) / curvature;
  found.td = options_.step * (static_cast<double>(least) - steps + shift);
  // Least squares: variance = 2 s^2 / (second derivative), s^2 the variance of a residual.
  const double variance = misfits[least] / (3.0 * found.pairs - 4.0);
  found.sigma = options_.step * std::sqrt(2.0 * variance / curvature);
  const bool is_good = found.sigma <= options_.max_sigma && found.misfit <= options_.max_misfit;
  return is_good ? std::make_optional(found) : std::nullopt;
}

/// The likelihood of all offsets beyond the neighbourhood is far below that of the least misfit.
/// With unknown noise its logarithm is -3 n / 2 ln(misfit) for n turns; half of that is counted, as
/// turns in a row are bent by the same parallax.
bool TimeOffsetSearch::isDistinct(const std::vector<double>& misfits, std::size_t least,
                                  std::size_t turns) const {
  const auto reach = static_cast<std::size_t>(options_.neighbourhood / options_.step);
  double other = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < misfits.size(); ++i) {
    if (i + reach < least || i > least + reach) other = std::min(other, misfits[i]);
  }
  const double log_ratio =
      0.75 * static_cast<double>(turns) * std::log(other / std::max(misfits[least], 1e-15));
  return log_ratio >= options_.min_log_ratio;
}

}  // namespace vins::estimator
