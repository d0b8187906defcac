#include "simulation/recording_simulator.h"

#include <gtest/gtest.h>

#include "simulation/euroc_rig.h"
#include "simulation/moving_objects.h"
#include "simulation/scene_catalogue.h"
#include "simulation/spline_fit.h"
#include "vins_core/input_error.h"
#include "vins_core/testing/shared_data.h"
#include "vins_core/trajectory_file.h"
#include "vins_pipeline/asl_folder.h"

namespace vins::simulation {
namespace {

RecordingOptions quickOptions() {
  RecordingOptions options;
  options.trajectory = "fast";
  options.imu_noise = "none";
  options.start = 5.0;
  options.duration = 2.0;
  return options;
}

TEST(RecordingSimulator, ImagesImuAndTruthAreOfOneMotion) {
  for (const double td : {0.0, 0.02, -0.033}) {
    RecordingOptions options = quickOptions();
    options.time_offset = td;
    const SimulatedRecording recording = simulateRecording(options);
    const TrajectorySpline& motion = recording.motion;
    EXPECT_EQ(recording.image_stamps.size(), 41u);
    EXPECT_EQ(recording.image_stamps.front() - motion.epoch(), 5000000000);
    // t_imu = t_cam + td: a sample tells of the camera's clock td earlier.
    for (const ArrivedSample& arrived : recording.imu) {
      const MotionState state = motion.at(motion.secondsAt(arrived.sample.stamp) - td);
      EXPECT_LT((arrived.sample.angular_velocity - state.angular_velocity_b).norm(), 1e-12);
    }
    for (const StampedPose& pose : recording.ground_truth.poses()) {
      EXPECT_EQ(pose.T_wb.position, motion.poseAt(motion.secondsAt(pose.stamp)).position);
    }
    // Every image has samples on both sides.
    const Stamp offset = toNanoseconds(td);
    EXPECT_LE(recording.imu.front().sample.stamp, recording.image_stamps.front() + offset);
    EXPECT_GE(recording.imu.back().sample.stamp, recording.image_stamps.back() + offset);
  }
}

TEST(RecordingSimulator, OfARecordedFlightTheCamerasClockIsBehindByTd) {
  const std::string file = vins::testing::sharedData("groundtruth/V2_01_easy.txt");
  VINS_SKIP_WITHOUT(file);
  RecordingOptions options;
  options.trajectory = file;
  options.recorded_imu =
      pipeline::readImuCsv(vins::testing::sharedData("recorded_imu/V2_01_easy.csv"));
  options.start = 20.0;
  options.duration = 2.0;
  options.time_offset = 0.03;
  const SimulatedRecording recording = simulateRecording(options);
  const SplineFit original = fitSpline(readTrajectoryFile(file));
  const StampedPose& pose = recording.ground_truth.poses()[100];
  const double imu_time = original.spline.secondsAt(pose.stamp + 30000000);
  EXPECT_LT((pose.T_wb.position - original.spline.poseAt(imu_time).position).norm(), 1e-9);
  // The recorded rates agree with the motion's, up to the gyroscope's bias of 0.085 rad/s, noise
  // and what vibrates faster than the ground truth tells.
  double squares = 0.0;
  for (const ArrivedSample& arrived : recording.imu) {
    const double t = recording.motion.secondsAt(arrived.sample.stamp) - 0.03;
    const Eigen::Vector3d bias(-0.0023, 0.0249, 0.0816);
    squares += (arrived.sample.angular_velocity - bias - recording.motion.at(t).angular_velocity_b)
                   .squaredNorm();
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(recording.imu.size())), 0.12);
}

TEST(RecordingSimulator, BlackoutsAndDroppedFramesCountFromTheStart) {
  RecordingOptions options = quickOptions();
  options.image_rate = 10.0;
  options.faults.frames.blackouts = {{1.0, 1.35}};
  options.faults.frames.dropped = {{0.5, 0.7}};
  const SimulatedRecording recording = simulateRecording(options);
  ASSERT_EQ(recording.image_stamps.size(), 19u);
  EXPECT_LT(cv::mean(recording.render(0, 8))[0], 3.0);    // at 1.0 s
  EXPECT_GT(cv::mean(recording.render(0, 12))[0], 20.0);  // at 1.4 s
}

TEST(RecordingSimulator, RefusesSpansThatAreNotThere) {
  const std::string file = vins::testing::sharedData("groundtruth/V1_01_easy.txt");
  VINS_SKIP_WITHOUT(file);
  RecordingOptions options;
  options.trajectory = file;
  options.start = 140.0;
  options.duration = 10.0;
  EXPECT_THROW(simulateRecording(options), InputError);
  options.start = 200.0;
  options.duration.reset();
  EXPECT_THROW(simulateRecording(options), InputError);
}

TEST(MovingObjects, KeepClearOfTheTrajectoryAndAreSeen) {
  const RecordingOptions options = quickOptions();
  const SimulatedRecording recording = simulateRecording(options);
  const Scene room = makeScene("room", 1);
  const TrajectorySpline& motion = recording.motion;
  const Scene filled = withMovingObjects(room, 3, motion, eurocCameraInBody(0), 5.0, 7.0, 4);
  ASSERT_EQ(filled.movingObjects().size(), room.movingObjects().size() + 3);
  for (double t = 5.0; t <= 7.0; t += 0.05) {
    EXPECT_TRUE(filled.isFree(motion.poseAt(t).position, 0.5)) << t;
  }
  // Nothing fits into a box around the trajectory.
  const Scene narrow(
      {}, {}, {},
      Eigen::AlignedBox3d(Eigen::Vector3d(-2.0, -1.3, 1.0), Eigen::Vector3d(2.0, 1.3, 2.0)));
  EXPECT_THROW(withMovingObjects(narrow, 1, motion, eurocCameraInBody(0), 0.0, 7.0, 4), InputError);
}

}  // namespace
}  // namespace vins::simulation
