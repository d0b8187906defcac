// The feature tracker on simulated recordings, where the truth is known.
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "tracked_truth.h"

namespace vins::simulation {
namespace {

struct Sequence {
  const char* name;
  const char* trajectory;
  const char* camera_file;  // empty: EuRoC's
  int moving_objects;
  double start = 4.0;  // [s]
};

SimulatedRecording recordingOf(const Sequence& sequence, double duration = 3.0) {
  RecordingOptions options;
  options.trajectory = sequence.trajectory;
  options.camera_file = sequence.camera_file;
  options.moving_objects = sequence.moving_objects;
  options.start = sequence.start;
  options.duration = duration;
  return simulateRecording(options);
}

TrackedTruth measure(const Sequence& sequence, bool gyroscope = true) {
  const TrackedTruth truth = trackRecording(recordingOf(sequence), {}, gyroscope);
  std::cout << sequence.name << ": " << truth << "\n";
  return truth;
}

/// The promises of the tracker, whatever the camera and the motion.
void expectGoodTracks(const TrackedTruth& truth) {
  EXPECT_GT(truth.features, 130.0);
  EXPECT_GT(truth.aged, 100);
  EXPECT_GE(truth.alignedShare(), 0.95);
  EXPECT_LT(truth.grossShare(), 0.01);
}

TEST(FeatureTrackerTruth, HallLoopKeepsItsTracksLong) {
  // Long enough that ages are not cut short by the sequence's begin.
  const TrackedTruth truth = trackRecording(recordingOf({"hall", "hall_loop", "", 0}, 10.0), {});
  std::cout << "hall, 10 s: " << truth << "\n";
  expectGoodTracks(truth);
  EXPECT_GT(medianOf(truth.ages), 20);
}

TEST(FeatureTrackerTruth, HallLoopAmongMovingObjects) {
  expectGoodTracks(measure({"hall, moving objects", "hall_loop", "", 4}));
}

TEST(FeatureTrackerTruth, HallLoopWithoutGyroscope) {
  expectGoodTracks(measure({"hall, no gyroscope", "hall_loop", "", 0}, false));
}

TEST(FeatureTrackerTruth, FastFlight) { expectGoodTracks(measure({"fast", "fast", "", 0})); }

TEST(FeatureTrackerTruth, FastFlightAmongMovingObjects) {
  // Objects on up to a quarter of the image, while the camera itself nearly stands for a moment.
  expectGoodTracks(measure({"fast, moving objects", "fast", "", 3}));
  expectGoodTracks(measure({"fast, moving objects, later", "fast", "", 3, 25.0}));
}

TEST(FeatureTrackerTruth, Fisheye) {
  const std::string camera = "../config/simulation/fisheye_camera.yaml";
  expectGoodTracks(measure({"fisheye", "hall_loop", camera.c_str(), 0}));
}

}  // namespace
}  // namespace vins::simulation
