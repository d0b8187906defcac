#include "vins_estimator/initialization/retiming.h"

#include <cmath>
#include <deque>
#include <memory>

#include <gtest/gtest.h>

#include "vins_core/time.h"

namespace vins::estimator {
namespace {

constexpr int kFrames = 30;

ImuSample sampleAt(int index) {
  ImuSample sample;
  const double t = 0.005 * index;
  sample.stamp = toNanoseconds(t);
  sample.angular_velocity = {std::sin(t), std::cos(3.0 * t), t};
  sample.acceleration = {std::cos(t), t * t, 9.81};
  return sample;
}

/// 2 s of samples and frames at 30 Hz, the first of them 0.3 s after the first sample.
MeasurementQueue filledQueue() {
  MeasurementQueue queue;
  for (int i = 0; i < 400; ++i) queue.addImu(sampleAt(i));
  for (int i = 0; i < kFrames + 10; ++i) {
    FeatureFrame frame;
    frame.stamp = toNanoseconds(0.3 + i / 30.0);
    queue.addFrame(frame);
  }
  return queue;
}

std::deque<SharedMeasurements> take(int count, double td, MeasurementQueue* queue) {
  std::deque<SharedMeasurements> frames;
  for (int i = 0; i < count; ++i) {
    auto next = queue->next(td);
    if (!next) break;
    frames.push_back(std::make_shared<const FrameMeasurements>(*std::move(next)));
  }
  return frames;
}

void expectSame(const FrameMeasurements& a, const FrameMeasurements& b) {
  ASSERT_EQ(a.frame.stamp, b.frame.stamp);
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.end, b.end);
  ASSERT_FALSE(a.imu.empty());
  EXPECT_EQ(a.imu.front().stamp, a.begin);
  EXPECT_EQ(a.imu.back().stamp, a.end);
  // Interpolated samples at the old intervals' ends may stand between; the integral is the same to
  // what straight lines make of straight lines.
  const auto integral = [](const FrameMeasurements& m) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < m.imu.size(); ++i) {
      sum += 0.5 * toSeconds(m.imu[i].stamp - m.imu[i - 1].stamp) *
             (m.imu[i].angular_velocity + m.imu[i - 1].angular_velocity + m.imu[i].acceleration +
              m.imu[i - 1].acceleration);
    }
    return sum;
  };
  EXPECT_LT((integral(a) - integral(b)).norm(), 1e-9);
}

class Retiming : public ::testing::TestWithParam<double> {};

TEST_P(Retiming, IsAsIfTheOffsetHadBeenKnownFromTheBeginning) {
  const double shift = GetParam();
  MeasurementQueue guessed = filledQueue();
  const std::deque<SharedMeasurements> before = take(kFrames, 0.02, &guessed);
  MeasurementQueue known = filledQueue();
  const std::deque<SharedMeasurements> truth = take(kFrames + 10, 0.02 + shift, &known);

  const RetimedFrames retimed = retime(before, shift);
  const int lost = shift > 0.0 ? static_cast<int>(std::ceil(shift * 30.0)) : 0;
  ASSERT_GE(static_cast<int>(retimed.frames.size()), kFrames - lost);
  for (std::size_t i = 1; i < retimed.frames.size(); ++i) {
    expectSame(*retimed.frames[i], *truth[i]);
  }

  // What comes next follows without a hole, and without an overlap.
  guessed.rewind(retimed.frames.back()->end, retimed.samples);
  const auto next = guessed.next(0.02 + shift);
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->begin, retimed.frames.back()->end);
  const auto same = guessed.next(0.02 + shift);
  ASSERT_TRUE(same.has_value());
  expectSame(*same, *truth[kFrames + 1]);
}
INSTANTIATE_TEST_SUITE_P(Shifts, Retiming, ::testing::Values(-0.2, -0.047, -0.001, 0.003, 0.1));

TEST(Retiming, LeavesOutWhatItsSamplesDoNotCover) {
  EXPECT_TRUE(retime({}, 0.1).frames.empty());
  MeasurementQueue queue = filledQueue();
  EXPECT_TRUE(retime(take(3, 0.0, &queue), 5.0).frames.empty());
}

}  // namespace
}  // namespace vins::estimator
