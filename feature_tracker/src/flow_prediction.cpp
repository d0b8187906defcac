#include "feature_tracker/flow_prediction.h"

#include <algorithm>
#include <cmath>

#include "vins_core/so3.h"
#include "vins_core/tangent_basis.h"

namespace vins::feature_tracker {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

std::vector<ImuSample> finiteSamplesAround(const std::vector<ImuSample>& imu, Stamp from,
                                           Stamp to) {
  std::vector<ImuSample> samples;
  for (const ImuSample& sample : imu) {
    const bool rises = samples.empty() || sample.stamp > samples.back().stamp;
    // A gyroscope with a topic of its own may leave its acceleration undefined.
    if (!sample.angular_velocity.allFinite() || !rises) continue;
    // Of the samples before the interval only the last one counts, of those after it the first.
    if (sample.stamp <= from) samples.clear();
    samples.push_back(sample);
    if (sample.stamp >= to) break;
  }
  return samples;
}

Vector3d rateAt(const ImuSample& a, const ImuSample& b, Stamp stamp) {
  const double share =
      static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return a.angular_velocity + share * (b.angular_velocity - a.angular_velocity);
}

}  // namespace

std::optional<Quaterniond> integrateGyroscope(const std::vector<ImuSample>& imu, Stamp from,
                                              Stamp to, double max_gap) {
  const std::vector<ImuSample> samples = finiteSamplesAround(imu, from, to);
  const Stamp gap = toNanoseconds(max_gap);
  if (samples.empty() || to <= from || samples.front().stamp - from > gap ||
      to - samples.back().stamp > gap) {
    return std::nullopt;
  }
  Quaterniond R_ab = Quaterniond::Identity();
  const auto turn = [&R_ab](const Vector3d& rate, Stamp duration) {
    if (duration > 0) R_ab = R_ab * so3::exp(rate * toSeconds(duration));
  };
  turn(samples.front().angular_velocity, std::min(samples.front().stamp, to) - from);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const ImuSample& a = samples[i - 1];
    const ImuSample& b = samples[i];
    if (b.stamp - a.stamp > gap) return std::nullopt;
    const Stamp begin = std::max(a.stamp, from);
    const Stamp end = std::min(b.stamp, to);
    turn(0.5 * (rateAt(a, b, begin) + rateAt(a, b, end)), end - begin);
  }
  turn(samples.back().angular_velocity, to - std::max(samples.back().stamp, from));
  return R_ab.normalized();
}

void TurnPrediction::addSamples(const std::vector<ImuSample>& imu) {
  samples_.insert(samples_.end(), imu.begin(), imu.end());
  // More than an image interval can need: images are refused, or never come.
  constexpr std::size_t kMost = 4000;
  if (samples_.size() > kMost) samples_.erase(samples_.begin(), samples_.end() - kMost);
}

CameraTurn TurnPrediction::predict(Stamp from, Stamp to) const {
  if (const auto R_b1b2 = integrateGyroscope(samples_, from, to)) {
    return {R_bc_.conjugate() * R_b1b2->conjugate() * R_bc_, true};
  }
  return {so3::exp(last_rate_ * toSeconds(to - from)), false};
}

void TurnPrediction::learn(const Quaterniond& R_21, Stamp from, Stamp to) {
  last_rate_ = so3::log(R_21) / toSeconds(to - from);
  // One sample from before the image's time stays: the next interval begins between two.
  std::size_t needless = 0;
  while (needless + 1 < samples_.size() && samples_[needless + 1].stamp <= to) ++needless;
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(needless));
}

void TurnPrediction::reset() {
  samples_.clear();
  last_rate_.setZero();
}

std::optional<Eigen::Vector2d> turnedPixel(const camera_model::Camera& camera,
                                           const Vector3d& bearing, const Quaterniond& R_ba) {
  return camera.project(R_ba * bearing);
}

std::optional<double> angularResolution(const camera_model::Camera& camera,
                                        const Vector3d& bearing) {
  camera_model::ProjectionJacobians jacobians;
  if (!camera.project(bearing, &jacobians)) return std::nullopt;
  const Eigen::Matrix2d J = jacobians.J_pixel_point * tangentBasis(bearing);
  const double area = std::abs(J.determinant());  // [px^2/rad^2]
  if (!(area > 0.0) || !std::isfinite(area)) return std::nullopt;
  return 1.0 / std::sqrt(area);
}

}  // namespace vins::feature_tracker
