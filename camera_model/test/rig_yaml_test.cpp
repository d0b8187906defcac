// A rig that is written reads back the same.

#include <string>

#include "camera_model/rig.h"
#include "camera_model/testing/example_cameras.h"
#include "rig_files.h"

namespace vins::camera_model {
namespace {

using namespace rig_files;  // NOLINT(google-build-using-namespace)

Rig read(const std::string& text) { return readRig(Parameters::parse(text, "rig.yaml")); }

void expectSameRig(const Rig& a, const Rig& b) {
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    const RigCamera &x = a.cameras[i], &y = b.cameras[i];
    EXPECT_EQ(x.camera->model(), y.camera->model());
    EXPECT_EQ(x.camera->name(), y.camera->name());
    EXPECT_EQ(x.camera->imageSize(), y.camera->imageSize());
    EXPECT_EQ(x.camera->parameters(), y.camera->parameters());
    EXPECT_EQ(x.image_topic, y.image_topic);
    EXPECT_EQ(x.camera_info_topic, y.camera_info_topic);
    EXPECT_LT(se3::log(x.T_bc.inverse() * y.T_bc).norm(), 1e-12);
    EXPECT_EQ(x.td, y.td);
    EXPECT_EQ(x.readout, y.readout);
    EXPECT_EQ(x.mask_file, y.mask_file);
  }
  EXPECT_EQ(a.imu.topic, b.imu.topic);
  EXPECT_EQ(a.imu.accel_topic, b.imu.accel_topic);
  EXPECT_EQ(a.imu.rate, b.imu.rate);
  EXPECT_EQ(a.imu.noise.accelerometer_noise, b.imu.noise.accelerometer_noise);
  EXPECT_EQ(a.imu.noise.gyroscope_noise, b.imu.noise.gyroscope_noise);
  EXPECT_EQ(a.imu.noise.accelerometer_walk, b.imu.noise.accelerometer_walk);
  EXPECT_EQ(a.imu.noise.gyroscope_walk, b.imu.noise.gyroscope_walk);
  EXPECT_EQ(a.imu.noise.gravity, b.imu.noise.gravity);
  EXPECT_EQ(a.imu.noise.vibration_share, b.imu.noise.vibration_share);
  EXPECT_EQ(a.extrinsic, b.extrinsic);
  EXPECT_EQ(a.estimate_td, b.estimate_td);
}

TEST(RigYaml, IsWrittenSoThatItReadsBackTheSame) {
  const std::string more =
      "fisheye: 1\nfisheye_mask: /rigs/my \\\"mask.png\n"
      "camera_info_topic: /cam0/camera_info\naccel_topic: /accel\n";
  for (const std::string& text : {vinsMono(), vinsMono() + more, camera(),
                                  chainCamera(0, bodyToCamera()) + chainCamera(1, firstToSecond()) +
                                      "imu0:\n" + kalibrImu("  ")}) {
    const Rig rig = read(text);
    expectSameRig(rig, read(toYaml(rig)));
  }
}

TEST(RigYaml, OfAnyCameraModelIsWrittenSoThatItReadsBackTheSame) {
  Rig rig = read(vinsMono());
  for (const auto& example : testing::exampleCameras()) {
    RigCamera camera;
    camera.camera = example;
    camera.image_topic = "/" + example->name();
    camera.T_bc =
        Pose(Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3).normalized(), {1.0 / 3.0, -0.1, 2.0});
    camera.td = 0.001;
    camera.readout = rig.cameras[0].readout;
    rig.cameras.push_back(camera);
  }
  expectSameRig(rig, read(toYaml(rig)));
}

}  // namespace
}  // namespace vins::camera_model
