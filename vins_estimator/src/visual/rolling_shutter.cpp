#include "vins_estimator/visual/rolling_shutter.h"

#include <algorithm>

#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The body's turn from the first sample to `seconds` later: its frame then in its frame at first.
/// Rates are taken as linear between samples and constant after the last.
Quaterniond turnAfter(const std::vector<ImuSample>& gyro, double seconds) {
  Quaterniond turn = Quaterniond::Identity();
  const Stamp begin = gyro.front().stamp;
  double done = 0.0;
  for (std::size_t i = 1; i < gyro.size() && done < seconds; ++i) {
    const double end = std::min(seconds, toSeconds(gyro[i].stamp - begin));
    const Vector3d rate = 0.5 * (gyro[i - 1].angular_velocity + gyro[i].angular_velocity);
    turn = turn * so3::exp((end - done) * rate);
    done = end;
  }
  if (done < seconds) turn = turn * so3::exp((seconds - done) * gyro.back().angular_velocity);
  return turn;
}

}  // namespace

FeatureFrame atFirstRow(const FeatureFrame& frame, const RollingShutter& shutter,
                        const std::vector<ImuSample>& gyro, const Vector3d& mean_rate_b) {
  FeatureFrame result = frame;
  result.observations.clear();
  const Vector3d mean_rate_c = shutter.R_bc.conjugate() * mean_rate_b;
  for (const FeatureObservation& feature : frame.observations) {
    if (!feature.hasVelocity()) continue;
    const double late = shutter.rowTime(feature.pixel.y());
    const Quaterniond turn_b = gyro.empty() ? Quaterniond::Identity() : turnAfter(gyro, late);
    const Quaterniond turn_c = shutter.R_bc.conjugate() * turn_b * shutter.R_bc;
    // What its motion had besides the turn.
    const Vector3d shift = feature.bearing_velocity + mean_rate_c.cross(feature.bearing);
    FeatureObservation corrected = feature;
    corrected.bearing = (turn_c * feature.bearing - late * shift).normalized();
    result.observations.push_back(corrected);
  }
  return result;
}

Eigen::Vector3d meanRate(const std::vector<ImuSample>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) sum += sample.angular_velocity;
  return samples.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(samples.size()));
}

}  // namespace vins::estimator
