#include "vins_estimator/initialization/time_offset_search.h"

#include <gtest/gtest.h>

#include "synthetic_flight.h"
#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kImuPeriod = 0.005;
constexpr double kFramePeriod = 0.05;

/// Turn rate of a hand that looks around, in the body frame [rad/s].
Vector3d rateAt(double t) {
  return {0.4 * std::sin(5.0 * t), 0.3 * std::sin(3.1 * t + 1.0), 0.5 * std::sin(7.3 * t + 2.0)};
}

/// A body that only turns; its camera sees directions all around.
class TurningRig {
 public:
  explicit TurningRig(double td, const Vector3d& gyroscope_bias = Vector3d::Zero())
      : td_(td), bias_(gyroscope_bias) {
    Quaterniond R_wb = Quaterniond::Identity();
    for (int i = 0; i < 4000; ++i) {
      rotations_.push_back(R_wb);
      R_wb = R_wb * so3::exp(kImuPeriod * rateAt((i + 0.5) * kImuPeriod));
    }
  }

  /// The frame whose stamp is `t` by the camera's clock, with samples cut for an offset of zero.
  FrameMeasurements at(int index) const {
    FrameMeasurements measurements;
    const double t = 1.0 + index * kFramePeriod;
    measurements.frame.stamp = toNanoseconds(t);
    measurements.is_first = index == 0;
    const double begin = index == 0 ? 0.0 : t - kFramePeriod;
    for (double s = begin; s <= t + 1e-9; s += kImuPeriod) {
      ImuSample sample;
      sample.stamp = toNanoseconds(s);
      sample.angular_velocity = rateAt(s) + bias_;
      sample.acceleration = {0.0, 0.0, 9.81};
      measurements.imu.push_back(sample);
    }
    addFeatures(t + td_, &measurements.frame);
    return measurements;
  }

  const Quaterniond R_bc = so3::exp(Vector3d(0.3, -1.2, 0.7));

 private:
  void addFeatures(double t_imu, FeatureFrame* frame) const {
    const auto index = static_cast<std::size_t>(std::lround(t_imu / kImuPeriod));
    const Quaterniond R_wc = rotations_[index] * R_bc;
    std::int64_t id = 0;
    for (const Vector3d& p : testing::pointsInBox(60, {-1, -1, -1}, {1, 1, 1}, 5)) {
      FeatureObservation observation;
      observation.id = id++;
      observation.bearing = (R_wc.conjugate() * p.normalized()).normalized();
      observation.angular_resolution = 1.0 / 460.0;
      frame->observations.push_back(observation);
    }
  }

  double td_;
  Vector3d bias_;
  std::vector<Quaterniond> rotations_;
};

std::optional<TimeOffset> found(const TurningRig& rig, int frames) {
  TimeOffsetSearch search;
  for (int i = 0; i < frames; ++i) {
    const auto offset = search.addFrame(rig.at(i), rig.R_bc);
    if (offset) return offset;
  }
  return std::nullopt;
}

TEST(TimeOffsetSearch, FindsOffsetsOfEitherSignWithinTwoSeconds) {
  for (const double td : {-0.2, -0.06, 0.0, 0.03, 0.1, 0.2}) {
    const auto offset = found(TurningRig(td, {0.02, -0.01, 0.015}), 40);
    ASSERT_TRUE(offset.has_value()) << td;
    // The rate between samples is a straight line, and the grid's misfit a parabola: both to some
    // tenths of a millisecond.
    EXPECT_NEAR(offset->td, td, 1e-3);
    EXPECT_LT(offset->misfit, 0.01);
  }
}

TEST(TimeOffsetSearch, SaysNothingWithoutTurns) {
  TimeOffsetSearch search;
  const TurningRig rig(0.05);
  const FrameMeasurements still = rig.at(0);
  for (int i = 0; i < 60; ++i) {
    FrameMeasurements measurements = still;
    measurements.is_first = i == 0;
    measurements.frame.stamp += toNanoseconds(i * kFramePeriod);
    for (ImuSample& sample : measurements.imu) {
      sample.stamp += toNanoseconds(i * kFramePeriod);
      sample.angular_velocity.setZero();
    }
    EXPECT_FALSE(search.addFrame(measurements, rig.R_bc).has_value());
  }
}

TEST(TimeOffsetSearch, SaysNothingForAWrongExtrinsicRotation) {
  TimeOffsetSearch search;
  const TurningRig rig(0.05);
  const Quaterniond wrong = rig.R_bc * so3::exp(Vector3d(0.0, 1.6, 0.0));
  for (int i = 0; i < 60; ++i) EXPECT_FALSE(search.addFrame(rig.at(i), wrong).has_value());
}

}  // namespace
}  // namespace vins::estimator
