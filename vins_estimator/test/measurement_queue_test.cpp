#include "vins_estimator/inertial/measurement_queue.h"

#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::estimator {
namespace {

constexpr Stamp kMs = 1'000'000;
constexpr Stamp kStart = 1'600'000'000'000 * kMs;

/// A sample whose values are linear in time, so that interpolation is exact.
ImuSample sampleAt(Stamp stamp) {
  const double t = toSeconds(stamp - kStart);
  return {stamp, {t, 2.0 * t, 9.81}, {-t, 0.5, 3.0 * t}};
}

FeatureFrame frameAt(Stamp stamp) {
  FeatureFrame frame;
  frame.stamp = stamp;
  return frame;
}

void addImu(MeasurementQueue* queue, Stamp from, Stamp to, Stamp step = 5 * kMs) {
  for (Stamp stamp = from; stamp <= to; stamp += step) queue->addImu(sampleAt(stamp));
}

void expectInterval(const FrameMeasurements& cut, Stamp begin, Stamp end) {
  EXPECT_EQ(cut.begin, begin);
  EXPECT_EQ(cut.end, end);
  ASSERT_GE(cut.imu.size(), 2u);
  EXPECT_EQ(cut.imu.front().stamp, begin);
  EXPECT_EQ(cut.imu.back().stamp, end);
  for (std::size_t i = 1; i < cut.imu.size(); ++i) {
    EXPECT_GT(cut.imu[i].stamp, cut.imu[i - 1].stamp);
  }
  for (std::size_t i = 0; i < cut.imu.size(); ++i) {
    const ImuSample expected = sampleAt(cut.imu[i].stamp);
    EXPECT_LT((cut.imu[i].acceleration - expected.acceleration).norm(), 1e-12);
    EXPECT_LT((cut.imu[i].angular_velocity - expected.angular_velocity).norm(), 1e-12);
  }
}

std::map<std::string, Event> eventsOf(MeasurementQueue* queue) {
  std::map<std::string, Event> events;
  for (const Event& event : queue->takeEvents()) {
    EXPECT_EQ(events.count(event.code), 0u) << "told twice: " << event;
    events[event.code] = event;
  }
  return events;
}

double figure(const Event& event, const std::string& name) {
  for (const auto& [key, value] : event.figures) {
    if (key == name) return value;
  }
  return std::nan("");
}

TEST(MeasurementQueue, IntervalsRunFromFrameToFrame) {
  MeasurementQueue queue;
  for (int i = 0; i < 5; ++i) queue.addFrame(frameAt(kStart + (103 + 50 * i) * kMs));
  addImu(&queue, kStart, kStart + 310 * kMs);
  const auto first = queue.next(0.0);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->is_first);
  EXPECT_FALSE(first->restarted);
  expectInterval(*first, kStart, kStart + 103 * kMs);
  for (int i = 1; i < 5; ++i) {
    const auto cut = queue.next(0.0);
    ASSERT_TRUE(cut);
    EXPECT_FALSE(cut->is_first);
    expectInterval(*cut, kStart + (53 + 50 * i) * kMs, kStart + (103 + 50 * i) * kMs);
    EXPECT_EQ(cut->imu.size(), 12u);
    EXPECT_NEAR(cut->longest_gap, 0.005, 1e-12);
    EXPECT_FALSE(cut->has_gap);
  }
  EXPECT_FALSE(queue.next(0.0));
  EXPECT_TRUE(queue.takeEvents().empty());
  EXPECT_LE(queue.sampleCount(), 3u) << "what is past is forgotten";
}

TEST(MeasurementQueue, AFrameWaitsForItsSamples) {
  MeasurementQueue queue;
  queue.addFrame(frameAt(kStart + 100 * kMs));
  EXPECT_FALSE(queue.next(0.0));
  addImu(&queue, kStart, kStart + 95 * kMs);
  EXPECT_FALSE(queue.next(0.0));
  EXPECT_TRUE(queue.next(-0.005));
  queue.addFrame(frameAt(kStart + 150 * kMs));
  addImu(&queue, kStart + 100 * kMs, kStart + 150 * kMs);
  EXPECT_FALSE(queue.next(0.001));
  EXPECT_TRUE(queue.next(0.0));
}

TEST(MeasurementQueue, TheTimeOffsetMovesIntervalsWhichStayJoined) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 400 * kMs);
  for (int i = 0; i < 4; ++i) queue.addFrame(frameAt(kStart + (100 + 50 * i) * kMs));
  Stamp end = kStart;
  for (const double td : {0.01, 0.012, 0.008, -0.003}) {
    const auto cut = queue.next(td);
    ASSERT_TRUE(cut);
    expectInterval(*cut, end, cut->frame.stamp + toNanoseconds(td));
    end = cut->end;
  }
}

TEST(MeasurementQueue, IntervalsShorterThanASamplePeriodWork) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 200 * kMs, 20 * kMs);
  for (int i = 0; i < 6; ++i) queue.addFrame(frameAt(kStart + (101 + 3 * i) * kMs));
  ASSERT_TRUE(queue.next(0.0));
  for (int i = 1; i < 6; ++i) {
    const auto cut = queue.next(0.0);
    ASSERT_TRUE(cut);
    expectInterval(*cut, kStart + (98 + 3 * i) * kMs, kStart + (101 + 3 * i) * kMs);
    EXPECT_EQ(cut->imu.size(), 2u);
  }
}

TEST(MeasurementQueue, AFirstFrameGetsTheSecondBeforeIt) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 10'000 * kMs);
  EXPECT_LT(queue.sampleCount(), 410u) << "kept without bound while no frame comes";
  queue.addFrame(frameAt(kStart + 9'998 * kMs));
  const auto cut = queue.next(0.0);
  ASSERT_TRUE(cut);
  expectInterval(*cut, kStart + 8'998 * kMs, kStart + 9'998 * kMs);
}

TEST(MeasurementQueue, DropsAndCountsBadSamples) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 100 * kMs);
  ImuSample bad = sampleAt(kStart + 105 * kMs);
  bad.acceleration.y() = std::numeric_limits<double>::quiet_NaN();
  queue.addImu(bad);
  queue.addImu(sampleAt(kStart + 110 * kMs));
  queue.addImu(sampleAt(kStart + 110 * kMs));
  queue.addImu(sampleAt(kStart + 100 * kMs - 1));
  // The first is told at once, the others together, a second later.
  auto events = eventsOf(&queue);
  ASSERT_EQ(events.count("imu_disorder"), 1u);
  EXPECT_EQ(figure(events["imu_disorder"], "not_finite"), 1.0);
  EXPECT_EQ(figure(events["imu_disorder"], "duplicates"), 0.0);
  addImu(&queue, kStart + 115 * kMs, kStart + 1'300 * kMs);
  events = eventsOf(&queue);
  ASSERT_EQ(events.count("imu_disorder"), 1u);
  EXPECT_EQ(events.count("imu_gap"), 0u) << "a single missing sample is none";
  EXPECT_EQ(figure(events["imu_disorder"], "not_finite"), 0.0);
  EXPECT_EQ(figure(events["imu_disorder"], "duplicates"), 1.0);
  EXPECT_EQ(figure(events["imu_disorder"], "out_of_order"), 1.0);
  queue.addFrame(frameAt(kStart + 120 * kMs));
  const auto cut = queue.next(0.0);
  ASSERT_TRUE(cut);
  expectInterval(*cut, kStart, kStart + 120 * kMs);
}

TEST(MeasurementQueue, GapsAreToldAndCountForEveryIntervalTheyTouch) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 120 * kMs);
  addImu(&queue, kStart + 320 * kMs, kStart + 500 * kMs);
  const auto events = eventsOf(&queue);
  ASSERT_EQ(events.count("imu_gap"), 1u);
  EXPECT_NEAR(figure(events.at("imu_gap"), "gap_s"), 0.2, 1e-9);
  for (int i = 0; i < 8; ++i) queue.addFrame(frameAt(kStart + (100 + 50 * i) * kMs));
  const bool expected[] = {false, true, true, true, true, true, false, false};
  for (const bool has_gap : expected) {
    const auto cut = queue.next(0.0);
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->has_gap, has_gap) << toSeconds(cut->end - kStart);
    EXPECT_NEAR(cut->longest_gap, has_gap ? 0.2 : 0.005, 1e-9);
    expectInterval(*cut, cut->begin, cut->end);
  }
}

TEST(MeasurementQueue, TheRateIsMeasured) {
  MeasurementQueue queue;
  EXPECT_NEAR(queue.imuPeriod(), 0.005, 1e-12);
  for (int i = 0; i < 200; ++i) {
    // Jitter of a tenth of the period, and now and then a missing sample.
    if (i % 17 != 0) queue.addImu(sampleAt(kStart + i * 4 * kMs + (i % 3) * 200'000));
  }
  EXPECT_NEAR(queue.imuPeriod(), 0.004, 0.0003);
  EXPECT_TRUE(queue.takeEvents().empty());
}

TEST(MeasurementQueue, ASlowSensorIsNotAllGaps) {
  MeasurementQueueOptions options;
  options.imu_rate = 200.0;
  MeasurementQueue queue(options);
  addImu(&queue, kStart, kStart + 20'000 * kMs, 20 * kMs);
  // Only until the rate is known.
  EXPECT_LE(queue.takeEvents().size(), 5u);
  EXPECT_NEAR(queue.imuPeriod(), 0.02, 1e-9);
  addImu(&queue, kStart + 20'020 * kMs, kStart + 30'000 * kMs, 20 * kMs);
  EXPECT_TRUE(queue.takeEvents().empty());
}

TEST(MeasurementQueue, FramesBeforeTheFirstSampleAreDropped) {
  MeasurementQueue queue;
  for (int i = 0; i < 4; ++i) queue.addFrame(frameAt(kStart + i * 50 * kMs));
  addImu(&queue, kStart + 120 * kMs, kStart + 300 * kMs);
  const auto cut = queue.next(0.0);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->frame.stamp, kStart + 150 * kMs);
  EXPECT_EQ(figure(eventsOf(&queue)["frames_dropped"], "before_imu"), 1.0) << "the others follow";
}

TEST(MeasurementQueue, RepeatedAndLateFramesAreDropped) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 300 * kMs);
  for (const Stamp ms : {100, 150, 150, 120, 200}) queue.addFrame(frameAt(kStart + ms * kMs));
  for (const Stamp ms : {100, 150, 200}) {
    const auto cut = queue.next(0.0);
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->frame.stamp, kStart + ms * kMs);
  }
  EXPECT_FALSE(queue.next(0.0));
  EXPECT_EQ(eventsOf(&queue).count("frames_dropped"), 1u);
}

TEST(MeasurementQueue, AStampFarAheadDoesNotBlockTheQueue) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 300 * kMs);
  queue.addFrame(frameAt(kStart + 100 * kMs));
  queue.addFrame(frameAt(kStart + 3'600'000 * kMs));
  queue.addFrame(frameAt(kStart + 150 * kMs));
  EXPECT_TRUE(queue.next(0.0));
  EXPECT_TRUE(queue.next(0.0));
  EXPECT_EQ(figure(eventsOf(&queue)["frames_dropped"], "ahead"), 1.0);
}

TEST(MeasurementQueue, ABoundedQueueDropsTheOldestAnUnboundedNone) {
  MeasurementQueueOptions options;
  MeasurementQueue unbounded(options);
  options.max_frames = 3;
  MeasurementQueue bounded(options);
  for (int i = 0; i < 100; ++i) {
    unbounded.addFrame(frameAt(kStart + i * 50 * kMs));
    bounded.addFrame(frameAt(kStart + i * 50 * kMs));
  }
  EXPECT_EQ(unbounded.frameCount(), 100u);
  EXPECT_EQ(bounded.frameCount(), 3u);
  double dropped = 0.0;
  for (const Event& event : bounded.takeEvents()) dropped += figure(event, "queue_full");
  // Those of the last second are still to be told.
  EXPECT_GE(dropped, 97.0 - 21.0);
  addImu(&bounded, kStart, kStart + 6'000 * kMs);
  EXPECT_EQ(bounded.next(0.0)->frame.stamp, kStart + 97 * 50 * kMs);
}

/// Either stream may be the first to jump.
TEST(MeasurementQueue, ARestartedRecordingStartsAnew) {
  for (const bool imu_first : {true, false}) {
    MeasurementQueue queue;
    addImu(&queue, kStart + 20'000 * kMs, kStart + 20'200 * kMs);
    queue.addFrame(frameAt(kStart + 20'100 * kMs));
    queue.addFrame(frameAt(kStart + 20'250 * kMs));
    ASSERT_TRUE(queue.next(0.0));
    if (imu_first) addImu(&queue, kStart, kStart + 200 * kMs);
    queue.addFrame(frameAt(kStart + 100 * kMs));
    queue.addFrame(frameAt(kStart + 150 * kMs));
    if (!imu_first) addImu(&queue, kStart, kStart + 200 * kMs);
    const auto first = queue.next(0.0);
    ASSERT_TRUE(first) << imu_first;
    EXPECT_TRUE(first->restarted);
    EXPECT_TRUE(first->is_first);
    expectInterval(*first, kStart, kStart + 100 * kMs);
    const auto second = queue.next(0.0);
    ASSERT_TRUE(second);
    EXPECT_FALSE(second->restarted);
    expectInterval(*second, kStart + 100 * kMs, kStart + 150 * kMs);
    const auto events = eventsOf(&queue);
    EXPECT_EQ(events.count("time_jump"), 1u) << imu_first;
    EXPECT_EQ(events.size(), 1u);
  }
}

TEST(MeasurementQueue, ClearForgetsEverything) {
  MeasurementQueue queue;
  addImu(&queue, kStart, kStart + 200 * kMs);
  queue.addFrame(frameAt(kStart + 100 * kMs));
  ASSERT_TRUE(queue.next(0.0));
  queue.addFrame(frameAt(kStart + 150 * kMs));
  queue.clear();
  EXPECT_EQ(queue.frameCount(), 0u);
  EXPECT_EQ(queue.sampleCount(), 0u);
  addImu(&queue, kStart, kStart + 200 * kMs);
  queue.addFrame(frameAt(kStart + 50 * kMs));
  const auto cut = queue.next(0.0);
  ASSERT_TRUE(cut);
  EXPECT_TRUE(cut->is_first);
  EXPECT_FALSE(cut->restarted);
  EXPECT_TRUE(queue.takeEvents().empty());
}

TEST(MeasurementQueue, RefusesBadOptions) {
  MeasurementQueueOptions options;
  options.imu_rate = 0.0;
  EXPECT_THROW(MeasurementQueue{options}, InputError);
  options = {};
  options.max_frames = -1;
  EXPECT_THROW(MeasurementQueue{options}, InputError);
}

TEST(AngularAcceleration, IsTheSlopeOfTheLastReadings) {
  std::vector<ImuSample> samples(11);
  for (int k = 0; k <= 10; ++k) {
    samples[k].stamp = 5'000'000 * k;
    samples[k].angular_velocity = {0.1 * k, k < 5 ? 3.0 : 1.0, 0.0};
  }
  EXPECT_LT((angularAcceleration(samples) - Eigen::Vector3d(20.0, 0.0, 0.0)).norm(), 1e-9);
  EXPECT_TRUE(angularAcceleration({}).isZero(0.0));
}

}  // namespace
}  // namespace vins::estimator
