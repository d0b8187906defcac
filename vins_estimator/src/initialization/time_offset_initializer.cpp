#include "vins_estimator/initialization/time_offset_initializer.h"

#include <algorithm>

namespace vins::estimator {

bool TimeOffsetInitializer::awaits(Stamp now) {
  constexpr double kPatience = 3.0;  // [s]
  if (!enabled_ || found_) return false;
  if (!begin_ || now < *begin_) begin_ = now;
  return toSeconds(now - *begin_) < kPatience;
}

std::optional<TimeOffset> TimeOffsetInitializer::addFrame(const FrameMeasurements& measurements,
                                                          const Eigen::Quaterniond& R_bc) {
  if (!enabled_ || found_) return std::nullopt;
  std::optional<TimeOffset> found = search_.addFrame(measurements, R_bc);
  if (!found) return std::nullopt;
  found_ = true;
  constexpr double kLeastSigma = 3e-3;  // [s]
  found->sigma = std::max(kLeastSigma, 2.0 * found->sigma);
  return found;
}

void TimeOffsetInitializer::clear() {
  search_.clear();
  found_ = false;
  begin_.reset();
}

Event toEvent(Stamp stamp, const TimeOffset& found) {
  return {stamp,
          Severity::kInfo,
          "time_offset_found",
          "the time offset of camera and IMU is known from their turns",
          {{"td_s", found.td},
           {"sigma_s", found.sigma},
           {"pairs", static_cast<double>(found.pairs)},
           {"misfit", found.misfit}}};
}

}  // namespace vins::estimator
