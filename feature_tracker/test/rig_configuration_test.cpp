#include "rig_configuration.h"

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::feature_tracker {
namespace {

const char kCamera[] = R"(%YAML:1.0
---
model_type: PINHOLE
camera_name: camera
image_width: 752
image_height: 480
distortion_parameters: {k1: -0.28, k2: 0.07, p1: 0.0002, p2: 0.00002}
projection_parameters: {fx: 458.0, fy: 457.0, cx: 367.0, cy: 248.0}
image_topic: /cam0/image_raw
imu_topic: /imu0
)";

TEST(RigConfiguration, ReadsVinsMonosForm) {
  const std::string text = std::string(kCamera) +
                           "estimate_extrinsic: 0\nextrinsicRotation: !!opencv-matrix\n"
                           "  rows: 3\n  cols: 3\n  dt: d\n  data: [0,-1,0, 1,0,0, 0,0,1]\n";
  const auto rig = readRigConfiguration(Parameters::parse(text, "rig.yaml"));
  EXPECT_EQ(rig.image_topic, "/cam0/image_raw");
  EXPECT_EQ(rig.imu_topic, "/imu0");
  ASSERT_EQ(rig.cameras.size(), 1U);
  EXPECT_TRUE(rig.rotation_known);
  EXPECT_LT((rig.T_bc[0] * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(RigConfiguration, KnowsWhenTheExtrinsicIsUnknown) {
  const auto rig = readRigConfiguration(
      Parameters::parse(std::string(kCamera) + "estimate_extrinsic: 2\n", "rig.yaml"));
  EXPECT_FALSE(rig.rotation_known);
}

TEST(RigConfiguration, NeedsTheSecondCamerasCalibration) {
  const std::string text = std::string(kCamera) + "image1_topic: /cam1/image_raw\n";
  try {
    readRigConfiguration(Parameters::parse(text, "rig.yaml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cam1_calib"), std::string::npos);
  }
}

}  // namespace
}  // namespace vins::feature_tracker
