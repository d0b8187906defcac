#include "vins_estimator/initialization/scale_convergence.h"

namespace vins::estimator {
namespace {

constexpr double kFirstInterval = 0.5;  // [s]
constexpr double kGrowth = 1.4;         // of the intervals
constexpr double kLongest = 10.0;       // of a convergence [s]
constexpr double kClearly = 0.7;        // of the deviation so far: a solution that is worth a jump

}  // namespace

void ScaleConvergence::begin(Stamp stamp, double scale_sigma) {
  scale_sigma_.reset();
  if (scale_sigma <= kConverged) return;
  scale_sigma_ = scale_sigma;
  begin_ = stamp;
  interval_ = kFirstInterval;
  next_ = stamp + toNanoseconds(interval_);
}

bool ScaleConvergence::isDue(Stamp stamp) {
  if (!scale_sigma_ || stamp < next_) return false;
  if (toSeconds(stamp - begin_) > kLongest) {
    clear();
    return false;
  }
  interval_ *= kGrowth;
  next_ = stamp + toNanoseconds(interval_);
  return true;
}

bool ScaleConvergence::take(double scale_sigma) {
  if (!scale_sigma_ || scale_sigma > kClearly * *scale_sigma_) return false;
  scale_sigma_ = scale_sigma;
  if (scale_sigma <= kConverged) clear();
  return true;
}

}  // namespace vins::estimator
