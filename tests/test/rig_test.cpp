#include "simulation/rig.h"

#include <cmath>

#include <gtest/gtest.h>

#include "camera_model/camera_file.h"
#include "simulation/euroc_rig.h"
#include "vins_core/input_error.h"
#include "vins_core/parameters.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

Rig eurocRig() {
  Rig rig;
  for (const int camera : {0, 1}) {
    rig.cameras.push_back(eurocCamera(camera));
    rig.T_bc.push_back(eurocCameraInBody(camera));
  }
  rig.noise = eurocImuNoise();
  rig.time_offset = 0.012;
  rig.rolling_shutter_readout = 0.02;
  return rig;
}

TEST(Rig, IsReadBackFromItsYaml) {
  const Rig rig = eurocRig();
  const Parameters file = Parameters::parse(toVinsYaml(rig, 1), "rig.yaml");
  EXPECT_EQ(file.text("image_topic"), "/cam1/image_raw");
  EXPECT_EQ(file.text("imu_topic"), "/imu0");
  EXPECT_EQ(camera_model::readCamera(file)->parameters(), rig.cameras[1]->parameters());
  EXPECT_EQ(file.matrix("extrinsicTranslation", 3, 1), rig.T_bc[1].position);
  EXPECT_EQ(file.matrix("extrinsicRotation", 3, 3), rig.T_bc[1].rotation.toRotationMatrix());
  EXPECT_EQ(file.number("acc_n"), rig.noise.accelerometer_noise);
  EXPECT_EQ(file.number("gyr_w"), rig.noise.gyroscope_walk);
  EXPECT_EQ(file.number("td"), 0.012);
  EXPECT_TRUE(file.flag("rolling_shutter"));
  EXPECT_EQ(file.number("rolling_shutter_tr"), 0.02);
  EXPECT_FALSE(file.flag("estimate_extrinsic"));
  EXPECT_EQ(file.integer("max_cnt"), 150);
}

TEST(Rig, CalibrationErrorsHaveTheirSize) {
  const Rig rig = eurocRig();
  double focal = 0.0, centre = 0.0, rotation = 0.0, translation = 0.0;
  const int runs = 300;
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    const Rig erring = withCalibrationError(rig, 2.0, seed);
    const camera_model::CameraParameters p = rig.cameras[0]->parameters(),
                                         q = erring.cameras[0]->parameters();
    focal += std::pow(q[0] / p[0] - 1.0, 2);
    centre += std::pow(q[2] - p[2], 2);
    rotation +=
        so3::log(rig.T_bc[0].rotation.conjugate() * erring.T_bc[0].rotation).squaredNorm() / 3.0;
    translation += (erring.T_bc[0].position - rig.T_bc[0].position).squaredNorm() / 3.0;
    EXPECT_TRUE(erring.estimate_extrinsic);
  }
  // Two sigmas; the deviation of 300 draws is known to 4 %, five times which is 20 %.
  EXPECT_NEAR(std::sqrt(focal / runs), 0.002, 0.0004);
  EXPECT_NEAR(std::sqrt(centre / runs), 1.0, 0.2);
  EXPECT_NEAR(std::sqrt(rotation / runs), 0.4 * M_PI / 180.0, 0.0014);
  EXPECT_NEAR(std::sqrt(translation / runs), 0.004, 0.0008);
}

TEST(Rig, NoErrorLeavesTheRigAsItIsAndSeedsRepeat) {
  const Rig rig = eurocRig();
  EXPECT_EQ(toVinsYaml(withCalibrationError(rig, 0.0, 1), 0), toVinsYaml(rig, 0));
  EXPECT_EQ(toVinsYaml(withCalibrationError(rig, 1.0, 1), 0),
            toVinsYaml(withCalibrationError(rig, 1.0, 1), 0));
  EXPECT_NE(toVinsYaml(withCalibrationError(rig, 1.0, 1), 0),
            toVinsYaml(withCalibrationError(rig, 1.0, 2), 0));
  EXPECT_THROW(withCalibrationError(rig, -1.0, 1), InputError);
}

}  // namespace
}  // namespace vins::simulation
