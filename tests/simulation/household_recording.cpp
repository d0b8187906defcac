#include "simulation/household_recording.h"

#include <algorithm>
#include <cmath>

#include "camera_model/pinhole_radtan.h"
#include "simulation/random.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using camera_model::PinholeRadtan;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;
/// Axes of a device held upright: the camera's x is the body's x, its y and z too.
const Vector3d kLever(0.015, -0.004, 0.003);  ///< of the camera in the body [m]

/// Densities of the data sheets at 2 g and 125 to 250 deg/s (Bosch BST-BMI055-DS000,
/// BST-BMI160-DS000); the walks are those of Allan deviations that users publish.
ImuNoise dataSheet(bool bmi055) {
  if (bmi055) return {1.47e-3, 2.44e-4, 3.0e-4, 1.0e-5, 9.81};
  return {1.77e-3, 1.22e-4, 3.0e-4, 1.0e-5, 9.81};
}

ImuNoise times(const ImuNoise& noise, double factor) {
  ImuNoise scaled = noise;
  scaled.accelerometer_noise *= factor;
  scaled.gyroscope_noise *= factor;
  scaled.accelerometer_walk *= factor;
  scaled.gyroscope_walk *= factor;
  return scaled;
}

double clampedNormal(Random* random, double deviation) {
  return deviation * std::clamp(random->normal(), -2.0, 2.0);
}

/// Scales off by up to a percent and axes turned against each other by a milliradian or two.
Eigen::Matrix3d gainError(Random* random) {
  Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      gain(row, column) += clampedNormal(random, row == column ? 0.005 : 0.001);
    }
  }
  return gain;
}

ImuOptions drawImu(Random* random, const ImuNoise& sheet, double time_offset) {
  ImuOptions imu;
  imu.rate = 200.0;
  imu.noise = times(sheet, random->uniform(1.0, 2.0));
  imu.time_offset = time_offset;
  imu.initial_accelerometer_bias = 0.08 * random->normal3();
  imu.initial_gyroscope_bias = 0.008 * random->normal3();
  imu.accelerometer_gain = gainError(random);
  imu.gyroscope_gain = gainError(random);
  const double rates[] = {62.5, 100.0, 250.0};
  imu.accelerometer_rate = rates[static_cast<int>(random->uniform(0.0, 3.0))];
  imu.stamp_jitter_s = random->uniform(0.0, 4e-4);
  return imu;
}

std::shared_ptr<const camera_model::Camera> pinhole(const camera_model::ImageSize& size, double fx,
                                                    double fy, const Eigen::Vector2d& centre,
                                                    double k1, double k2) {
  camera_model::CameraParameters parameters(9);
  parameters << fx, fy, centre.x(), centre.y(), k1, k2, 0.0, 0.0, 0.0;
  return std::make_shared<PinholeRadtan>("cam0", size, parameters);
}

/// The true camera and the user's.
void drawCameras(Random* random, bool large, OwnRig* rig) {
  const camera_model::ImageSize size =
      large ? camera_model::ImageSize{1280, 720} : camera_model::ImageSize{640, 360};
  const double focal = 0.5 * size.width / std::tan(0.5 * random->uniform(66.0, 74.0) * kDegree);
  const double pixel = size.width / 640.0;
  const Eigen::Vector2d middle(0.5 * size.width, 0.5 * size.height);
  const auto off = [&](double deviation) { return clampedNormal(random, deviation); };
  const Eigen::Vector2d centre = middle + Eigen::Vector2d(off(3.0 * pixel), off(3.0 * pixel));
  rig->truth.cameras = {
      pinhole(size, focal, focal * (1.0 + off(0.001)), centre, off(0.012), off(0.008))};
  const double believed = focal * (1.0 + off(0.005));
  const Eigen::Vector2d believed_centre =
      centre + Eigen::Vector2d(off(1.5 * pixel), off(1.5 * pixel));
  rig->handed_out.cameras = {pinhole(size, believed, believed, believed_centre, 0.0, 0.0)};
}

void drawExtrinsic(Random* random, OwnRig* rig) {
  const Pose nominal(Eigen::Quaterniond::Identity(), kLever);
  Pose T_bc = nominal;
  T_bc.rotation = so3::exp(0.02 * random->normal3());
  T_bc.position += 0.004 * random->normal3();
  rig->truth.T_bc = {T_bc};
  Vector3d turn = random->normal3().normalized(), shift = random->normal3().normalized();
  turn *= random->uniform(0.2, 2.0) * kDegree;
  shift *= random->uniform(0.002, 0.010);
  rig->handed_out.T_bc = {{(T_bc.rotation * so3::exp(turn)).normalized(), T_bc.position + shift}};
}

OwnRig drawRig(Random* random, bool large) {
  OwnRig rig;
  drawCameras(random, large, &rig);
  drawExtrinsic(random, &rig);
  const double time_offset = random->uniform(-0.1, 0.1);
  const ImuNoise sheet = dataSheet(random->uniform() < 0.5);
  const double believed_share = random->uniform() < 0.5 ? 1.0 : 2.0;
  rig.imu = drawImu(random, sheet, time_offset);
  rig.truth.noise = rig.imu.noise;
  rig.truth.time_offset = time_offset;
  rig.truth.rolling_shutter_readout = random->uniform(0.010, 0.030);
  rig.handed_out.noise = times(sheet, believed_share);
  rig.handed_out.estimate_extrinsic = true;
  rig.handed_out.estimate_time_offset = true;
  rig.handed_out.self_calibration = true;
  return rig;
}

FrameTiming drawTiming(Random* random) {
  FrameTiming timing;
  const double rates[] = {15.0, 20.0, 24.0, 30.0};
  timing.rate = rates[static_cast<int>(random->uniform(0.0, 4.0))];
  if (timing.rate > 20.0) timing.slow_rate = 16.7;
  timing.drop_probability = random->uniform(0.0, 0.03);
  timing.burst_probability = 0.003;
  timing.stamp_jitter_s = random->uniform(0.0, 0.001);
  return timing;
}

ImageOptions drawImage(Random* random, bool large) {
  ImageOptions image;
  image.lens_blur_px = (large ? 0.9 : 0.55) * random->uniform(0.85, 1.25);
  image.vignetting = random->uniform(0.15, 0.4);
  image.full_well_electrons = 6000.0;
  image.read_noise_electrons = 6.0;
  image.jpeg_quality = static_cast<int>(random->uniform(70.0, 90.0));
  return image;
}

}  // namespace

RecordingOptions householdRecording(std::uint64_t seed, double duration) {
  Random random(seed, "household recording");
  RecordingOptions options;
  options.trajectory = "walk";
  options.scene = "household";
  options.seed = seed;
  options.duration = duration;
  options.start = random.uniform() < 0.4 ? 0.0 : random.uniform(2.0, 6.0);
  const bool large = random.uniform() < 0.25;
  options.own_rig = drawRig(&random, large);
  options.timing = drawTiming(&random);
  options.image_rate = options.timing.rate;
  options.image = drawImage(&random, large);
  options.image.rolling_shutter_readout_s = options.own_rig->truth.rolling_shutter_readout;
  options.auto_exposure = AutoExposure{};
  options.auto_exposure->target = random.uniform(0.25, 0.40);
  return options;
}

}  // namespace vins::simulation
