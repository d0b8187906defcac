#include "simulation/household_recording.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "simulation/household_scene.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

TEST(HouseholdRecording, SeedsRepeatAndDiffer) {
  const SimulatedRecording a = simulateRecording(householdRecording(3, 2.0));
  const SimulatedRecording b = simulateRecording(householdRecording(3, 2.0));
  const SimulatedRecording c = simulateRecording(householdRecording(4, 2.0));
  EXPECT_EQ(a.image_stamps, b.image_stamps);
  EXPECT_NE(a.image_stamps, c.image_stamps);
  EXPECT_EQ(a.imu[100].sample.acceleration, b.imu[100].sample.acceleration);
  const cv::Mat image = a.render(0, 5);
  EXPECT_EQ(cv::countNonZero(image != b.render(0, 5)), 0);
  EXPECT_EQ(toVinsYaml(a.rig, 0), toVinsYaml(b.rig, 0));
}

TEST(HouseholdRecording, HandsOutWhatAUserHas) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const RecordingOptions options = householdRecording(seed, 10.0);
    ASSERT_TRUE(options.own_rig);
    const Rig &truth = options.own_rig->truth, &user = options.own_rig->handed_out;
    EXPECT_EQ(user.time_offset, 0.0);
    EXPECT_TRUE(user.estimate_time_offset);
    EXPECT_TRUE(user.self_calibration);
    EXPECT_TRUE(user.estimate_extrinsic);
    EXPECT_EQ(user.rolling_shutter_readout, 0.0) << "whose read-out is unknown";
    const double focal_error =
        user.cameras[0]->parameters()[0] / truth.cameras[0]->parameters()[0] - 1.0;
    EXPECT_LE(std::abs(focal_error), 0.0101) << seed;
    const double turn = user.T_bc[0].rotation.angularDistance(truth.T_bc[0].rotation);
    EXPECT_LE(turn, 2.01 * kDegree) << seed;
    EXPECT_GT(turn, 0.1 * kDegree) << seed;
    EXPECT_LE((user.T_bc[0].position - truth.T_bc[0].position).norm(), 0.0101) << seed;
    EXPECT_EQ(truth.time_offset, options.own_rig->imu.time_offset);
    const ImuOptions& imu = options.own_rig->imu;
    for (const Eigen::Matrix3d& gain : {imu.accelerometer_gain, imu.gyroscope_gain}) {
      const double scale_error = (gain.diagonal().array() - 1.0).abs().maxCoeff();
      EXPECT_LE(scale_error, 0.0101) << seed;
      EXPECT_GT(scale_error, 0.0005) << seed;
    }
    EXPECT_LE(user.noise.gyroscope_noise, 2.0 * truth.noise.gyroscope_noise + 1e-12);
  }
}

TEST(HouseholdRecording, DrawsWhatTheFieldHas) {
  std::set<int> widths;
  std::set<double> rates, accelerometers;
  double least_td = 1.0, most_td = -1.0;
  int from_rest = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const RecordingOptions options = householdRecording(seed, 10.0);
    const Rig& truth = options.own_rig->truth;
    widths.insert(truth.cameras[0]->imageSize().width);
    rates.insert(options.image_rate);
    accelerometers.insert(options.own_rig->imu.accelerometer_rate);
    least_td = std::min(least_td, truth.time_offset);
    most_td = std::max(most_td, truth.time_offset);
    from_rest += options.start == 0.0 ? 1 : 0;
    EXPECT_GE(truth.rolling_shutter_readout, 0.010);
    EXPECT_LE(truth.rolling_shutter_readout, 0.030);
    EXPECT_GT(options.image.jpeg_quality, 0);
  }
  EXPECT_EQ(widths, (std::set<int>{640, 1280}));
  EXPECT_EQ(rates, (std::set<double>{15.0, 20.0, 24.0, 30.0}));
  EXPECT_EQ(accelerometers.size(), 3u);
  EXPECT_LT(least_td, -0.07);
  EXPECT_GT(most_td, 0.07);
  EXPECT_GT(from_rest, 10);
  EXPECT_LT(from_rest, 40);
}

TEST(HouseholdRecording, FramesAreIrregularAndExposureFollowsTheLight) {
  const SimulatedRecording recording = simulateRecording(householdRecording(2, 30.0));
  double least = 1.0, most = 0.0;
  for (std::size_t i = 1; i < recording.image_stamps.size(); ++i) {
    const double interval = toSeconds(recording.image_stamps[i] - recording.image_stamps[i - 1]);
    least = std::min(least, interval);
    most = std::max(most, interval);
  }
  EXPECT_GT(least, 0.02);
  EXPECT_GT(most, 1.8 * least);
  EXPECT_LT(most, 0.6);
}

}  // namespace
}  // namespace vins::simulation
