#include "camera_model/rig.h"

#include <cmath>
#include <string>

#include "rig_files.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

using namespace rig_files;  // NOLINT(google-build-using-namespace)

const Eigen::Vector3d kPlace(0.1, 0.2, 0.3);  ///< of the first camera, in the body frame

Rig read(const std::string& text) { return readRig(Parameters::parse(text, "rig.yaml")); }

std::string errorOf(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// How many warnings have this in them.
int countOf(const Rig& rig, const std::string& part) {
  int count = 0;
  for (const std::string& warning : rig.warnings) count += contains(warning, part) ? 1 : 0;
  return count;
}

/// Where the camera of rig_files stands and looks.
void expectPose(const Pose& T_bc, const Eigen::Vector3d& place) {
  EXPECT_LT((T_bc * Eigen::Vector3d::Zero() - place).norm(), 1e-12);
  EXPECT_LT((T_bc.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((T_bc.rotation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

class RigOfFiles : public RigFiles {};

TEST(Rig, ReadsVinsMonosForm) {
  const Rig rig = read(vinsMono());
  ASSERT_EQ(rig.cameras.size(), 1u);
  const RigCamera& camera = rig.cameras[0];
  EXPECT_EQ(camera.camera->name(), "left");
  EXPECT_EQ(camera.camera->parameters()[0], 458.5);
  EXPECT_EQ(camera.image_topic, "/cam0/image_raw");
  expectPose(camera.T_bc, kPlace);
  EXPECT_EQ(camera.td, -0.01);
  EXPECT_EQ(camera.readout, 0.03);
  EXPECT_EQ(rig.imu.topic, "/imu0");
  EXPECT_EQ(rig.imu.noise.gravity, 9.8);
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kTrusted);
  EXPECT_TRUE(rig.rotationIsKnown());
  EXPECT_TRUE(rig.estimate_td);
  EXPECT_TRUE(rig.warnings.empty()) << rig.warnings.front();
}

TEST_F(RigOfFiles, ReadsVinsFusionsFormWithOneCamera) {
  write("cam0.yaml", camera());
  // What is left over of a second camera, whose file is not there, does not matter.
  const Rig rig = readRigFile(write("rig.yaml", vinsFusion(1)));
  ASSERT_EQ(rig.cameras.size(), 1u);
  EXPECT_EQ(rig.cameras[0].image_topic, "/left/image_raw");
  EXPECT_EQ(rig.cameras[0].td, 0.005);
  expectPose(rig.cameras[0].T_bc, kPlace);
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kRefined);
  ASSERT_EQ(rig.warnings.size(), 1u);
  EXPECT_TRUE(contains(rig.warnings[0], "without effect here: multiple_thread, flow_back"));
}

TEST_F(RigOfFiles, ReadsVinsFusionsStereoForm) {
  write("cam0.yaml", camera());
  write("cam1.yaml", camera(470.0));
  const Rig rig = readRigFile(write("rig.yaml", vinsFusion(2)));
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[1].image_topic, "/right/image_raw");
  EXPECT_EQ(rig.cameras[1].camera->parameters()[0], 470.0);
  EXPECT_EQ(rig.cameras[1].td, 0.005) << "one clock for both, as VINS-Fusion has it";
  expectPose(rig.cameras[1].T_bc, {0.1, 0.31, 0.3});
  EXPECT_EQ(countOf(rig, "2 cameras: odometry goes by the first"), 1);
}

TEST_F(RigOfFiles, AFileNameLongerThanTheFileSystemTakesIsMissing) {
  std::string text = rig_files::vinsFusion(1);
  text.replace(text.find("cam0.yaml"), 4, std::string(5000, 'x'));
  EXPECT_THROW(readRigFile(write("rig.yaml", text)), InputError);
}

TEST_F(RigOfFiles, SaysWhereACamerasFileIsMissingOrOfAnotherSize) {
  const std::string rig = write("rig.yaml", vinsFusion(1));
  try {
    readRigFile(rig);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(),
                         "rig.yaml:8: key 'cam0_calib': found 'cam0.yaml', but there "
                         "is no "))
        << error.what();
  }
  write("cam0.yaml", replaced(camera(), "752", "640"));
  EXPECT_EQ(countOf(readRigFile(rig), "those of cam0_calib 640 x 480; the latter count"), 1);
}

TEST(Rig, ReadsKalibrsChainWithItsImu) {
  const Rig rig =
      read(chainCamera(0, bodyToCamera()) + "imu0:\n" + kalibrImu("  ") + "  model: calibrated\n");
  ASSERT_EQ(rig.cameras.size(), 1u);
  EXPECT_EQ(rig.cameras[0].image_topic, "/chain/cam0");
  EXPECT_EQ(rig.cameras[0].td, 0.007);
  expectPose(rig.cameras[0].T_bc, kPlace);
  EXPECT_EQ(rig.imu.topic, "/chain/imu");
  EXPECT_EQ(rig.imu.rate, 400.0);
  EXPECT_EQ(rig.imu.unit, ImuNoiseUnit::kDensity) << "Kalibr's are densities, large ones too";
  EXPECT_EQ(rig.imu.noise.accelerometer_noise, 0.04);
  EXPECT_EQ(rig.imu.noise.gyroscope_walk, 0.00002);
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kTrusted);
  EXPECT_EQ(countOf(rig, "of cam0, without effect here: cam_overlaps"), 1);
  EXPECT_EQ(countOf(rig, "of imu0, without effect here: model"), 1);
}

TEST(Rig, KeysAtTheTopGoBeforeThoseOfAChain) {
  const Rig rig = read("imu_topic: /my/imu\nimage_topic: /my/image\ntd: 0.02\nimu_rate: 100\n" +
                       chainCamera(0, bodyToCamera()) + "imu0:\n" + kalibrImu("  "));
  EXPECT_EQ(rig.imu.topic, "/my/imu");
  EXPECT_EQ(rig.cameras[0].image_topic, "/my/image");
  EXPECT_EQ(rig.cameras[0].td, 0.02);
  EXPECT_EQ(rig.imu.rate, 100.0);
}

TEST_F(RigOfFiles, ReadsKalibrsImuFileBesideTheChain) {
  const std::string chain = chainCamera(0, bodyToCamera());
  write("imu-flight.yaml", kalibrImu());
  const Rig rig = readRigFile(write("camchain-imucam-flight.yaml", chain));
  EXPECT_EQ(rig.imu.topic, "/chain/imu");
  EXPECT_EQ(rig.imu.noise.gyroscope_noise, 0.0002);
  EXPECT_EQ(countOf(rig, "the IMU's noise is read from "), 1);
  write("imu.yaml", replaced(kalibrImu(), "0.0002", "0.0005"));
  EXPECT_EQ(readRigFile(write("chain.yaml", chain)).imu.noise.gyroscope_noise, 0.0005);
}

TEST(Rig, ASecondCameraOfAChainStandsByTheFirst) {
  const Rig rig = read(chainCamera(0, bodyToCamera()) + chainCamera(1, firstToSecond()) +
                       "imu0:\n" + kalibrImu("  "));
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[1].image_topic, "/chain/cam1");
  // To the right of the first is along its x axis, which is the body's y axis.
  expectPose(rig.cameras[1].T_bc, {0.1, 0.31, 0.3});
}

TEST(Rig, WhatAChainLacksGetsDefaultsAndIsTold) {
  const Rig rig = read(chainCamera(0, ""));
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kUnknown);
  EXPECT_FALSE(rig.rotationIsKnown());
  EXPECT_EQ(rig.imu.noise.accelerometer_noise, 0.01);
  EXPECT_TRUE(rig.imu.topic.empty());
  EXPECT_EQ(countOf(rig, "taken is accelerometer_noise_density 0.01, "), 1);
  EXPECT_EQ(countOf(rig, "found by moving"), 1);
  // One of four that is missing is told alone.
  const Rig partly = read(chainCamera(0, bodyToCamera()) + "imu0:\n" +
                          replaced(kalibrImu("  "), "  gyroscope_random_walk: 0.00002\n", ""));
  EXPECT_EQ(partly.imu.noise.accelerometer_noise, 0.04);
  EXPECT_EQ(countOf(partly, "taken is gyroscope_random_walk 2e-05"), 1);
}

TEST_F(RigOfFiles, ReadsOpenVinssForm) {
  write("kalibr_imucam_chain.yaml",
        "%YAML:1.0\n\n" + chainCamera(0, cameraToBody()) + chainCamera(1, cameraToBody()));
  write("kalibr_imu_chain.yaml",
        "%YAML:1.0\n\nimu0:\n" + kalibrImu("  ") + "  model: \"kalibr\"\n");
  const Parameters parameters = Parameters::load(
      write("estimator_config.yaml",
            "%YAML:1.0\n\nverbosity: \"INFO\" # ALL, DEBUG\nuse_fej: true\nmax_cameras: 1\n"
            "calib_cam_extrinsics: true # degenerate motion\ncalib_cam_timeoffset: true\n"
            "gravity_mag: 9.79\nmax_clones: 11\nfreq: 10\n"
            "relative_config_imu: \"kalibr_imu_chain.yaml\"\n"
            "relative_config_imucam: \"kalibr_imucam_chain.yaml\"\n"));
  const Rig rig = readRig(parameters);
  ASSERT_EQ(rig.cameras.size(), 1u) << "as max_cameras says";
  expectPose(rig.cameras[0].T_bc, kPlace);
  EXPECT_EQ(rig.cameras[0].td, 0.007);
  EXPECT_EQ(rig.imu.topic, "/chain/imu");
  EXPECT_EQ(rig.imu.noise.gravity, 9.79);
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kRefined);
  EXPECT_TRUE(rig.estimate_td);
  EXPECT_EQ(countOf(rig, "of OpenVINS, without effect here: verbosity, use_fej, max_clones"), 1);
  EXPECT_EQ(parameters.warnings(), std::vector<std::string>()) << "told already";
}

TEST(Rig, OpenVinssChainAloneIsReadToo) {
  expectPose(read(chainCamera(0, cameraToBody())).cameras[0].T_bc, kPlace);
}

TEST(Rig, ACamerasFileAloneIsARigOfWhichTheRestIsUnknown) {
  const Rig rig = read(camera());
  EXPECT_EQ(rig.cameras.at(0).camera->parameters()[0], 458.5);
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kUnknown);
  EXPECT_EQ(rig.warnings.size(), 2u);
}

TEST(Rig, NoiseOfASampleBecomesADensity) {
  const auto noiseOf = [](const std::string& more, const std::string& noise_lines) {
    return read(replaced(vinsMono(), noise(), noise_lines) + more).imu;
  };
  RigImu imu = noiseOf("", noise());
  EXPECT_EQ(imu.unit, ImuNoiseUnit::kSample);
  EXPECT_NEAR(imu.noise.accelerometer_noise, 0.08 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(imu.noise.gyroscope_noise, 0.004 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(imu.noise.accelerometer_walk, 0.00004 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(imu.noise.gyroscope_walk, 2.0e-6 / std::sqrt(200.0), 1e-15);
  imu = noiseOf("imu_noise_unit: density\n", noise());
  EXPECT_EQ(imu.noise.accelerometer_noise, 0.08);
  EXPECT_EQ(imu.unit, ImuNoiseUnit::kDensity);
  EXPECT_NEAR(noiseOf("imu_rate: 400\n", noise()).noise.accelerometer_noise, 0.004, 1e-15);
  const std::string small = "acc_n: 0.02\ngyr_n: 0.001\nacc_w: 0.0004\ngyr_w: 2.0e-5\n";
  EXPECT_EQ(noiseOf("", small).noise.accelerometer_noise, 0.02);
  EXPECT_NEAR(noiseOf("imu_noise_unit: sample\n", small).noise.gyroscope_walk,
              2e-5 / std::sqrt(200.0), 1e-15);
}

TEST(Rig, NoiseOfZeroIsRaisedToAFloor) {
  const Rig rig = read(replaced(vinsMono(), "acc_w: 4.0e-5", "acc_w: 0"));
  EXPECT_GT(rig.imu.noise.accelerometer_walk, 0.0);
  EXPECT_EQ(countOf(rig, "key 'acc_w' is 0, which no sensor has"), 1);
  EXPECT_EQ(rig.warnings.size(), 1u);
  const Rig kalibr =
      read(chainCamera(0, bodyToCamera()) + "imu0:\n" + replaced(kalibrImu("  "), "0.003", "0.0"));
  EXPECT_EQ(countOf(kalibr, "key 'accelerometer_random_walk' is 0"), 1);
}

TEST(Rig, ARoughRotationIsTakenToTheNearestUpTo3Degrees) {
  const auto turned = [](const std::string& first_row) {
    return replaced(vinsMono(), "[0, -1, 0,", "[" + first_row + ",");
  };
  // 0.001: typed with three digits.
  EXPECT_TRUE(read(turned("0.0005, -1, 0")).warnings.empty());
  const Rig rough = read(turned("0.04, -0.99, 0"));
  EXPECT_EQ(countOf(rough, "key 'extrinsicRotation' is "), 1);
  const Eigen::Matrix3d R = rough.cameras[0].T_bc.rotation.toRotationMatrix();
  EXPECT_NEAR((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
  // The nearest rotation shares the error of the corner between both rows.
  EXPECT_NEAR(std::abs(R(0, 0)), 0.02, 1e-3);
  EXPECT_TRUE(contains(errorOf(turned("0.2, -1, 0")),
                       "'extrinsicRotation': found a matrix that is "
                       "no rotation"));
  EXPECT_TRUE(contains(errorOf(turned("0, 1, 0")), "no rotation (determinant -1)"));
}

TEST(Rig, AnUnusedMatrixIsNotJudged) {
  const std::string unknown =
      replaced(vinsMono(), "estimate_extrinsic: 0", "estimate_extrinsic: 2");
  Rig rig = read(replaced(unknown, "[0, -1, 0,\n          1, 0, 0,\n          0, 0, 1]",
                          "[0, 0, 0, 0, 0, 0, 0, 0, 0]"));
  EXPECT_EQ(rig.extrinsic, ExtrinsicMode::kUnknown);
  EXPECT_FALSE(rig.rotationIsKnown()) << "whatever the matrix is";
  EXPECT_TRUE(rig.cameras[0].T_bc.rotation.isApprox(Eigen::Quaterniond::Identity()));
  EXPECT_TRUE(rig.warnings.empty());
  rig = read(replaced(unknown, "rows: 3\n   cols: 3", "rows: 9\n   cols: 9"));
  EXPECT_TRUE(rig.cameras[0].T_bc.position.isZero(0.0));
  EXPECT_FALSE(read(unknown).rotationIsKnown());
}

TEST(Rig, TheExtrinsicMayBeAbsentOnlyWhereItIsToBeFound) {
  const std::string bare = camera() + noise();
  EXPECT_EQ(read(bare + "estimate_extrinsic: 2\n").extrinsic, ExtrinsicMode::kUnknown);
  for (const std::string mode : {"", "estimate_extrinsic: 0\n", "estimate_extrinsic: 1\n"}) {
    const std::string message = errorOf(bare + mode);
    EXPECT_TRUE(contains(message, "rig.yaml: key 'extrinsicRotation' is missing")) << message;
    EXPECT_TRUE(contains(message, "estimate_extrinsic is 2")) << message;
  }
}

TEST(Rig, TopicsMayEndInASlashOrBeRelative) {
  const Rig rig = read(replaced(replaced(vinsMono(), "\"/imu0\"", "\"/imu0/\""),
                                "\"/cam0/image_raw\"", "cam0/image_raw"));
  EXPECT_EQ(rig.imu.topic, "/imu0");
  EXPECT_EQ(rig.cameras[0].image_topic, "cam0/image_raw") << "seen from the node's namespace";
  EXPECT_EQ(countOf(rig, "the topic '/imu0/' is taken as '/imu0'"), 1);
}

TEST(Rig, AMaskIsTakenWhereTheFileSaysSo) {
  const auto maskOf = [](const std::string& lines) {
    return readRig(Parameters::parse(vinsMono() + lines, "/rigs/rig.yaml"));
  };
  EXPECT_EQ(maskOf("fisheye: 1\nfisheye_mask: mask.png\n").cameras[0].mask_file, "/rigs/mask.png");
  EXPECT_EQ(maskOf("fisheye: 0\nfisheye_mask: mask.png\n").cameras[0].mask_file, "");
  EXPECT_TRUE(maskOf("fisheye: 0\nfisheye_mask:\n").warnings.empty());
  EXPECT_EQ(countOf(maskOf("fisheye: 1\n"), "fisheye_mask names no file"), 1);
}

TEST(Rig, ALensWithoutDistortionIsTold) {
  const std::string text = vinsMono();
  const std::size_t from = text.find("distortion_parameters");
  const Rig rig = read(text.substr(0, from) + text.substr(text.find("projection_parameters")));
  EXPECT_TRUE(rig.cameras[0].camera->parameters().tail(5).isZero(0.0));
  EXPECT_EQ(countOf(rig, "free of distortion"), 1);
}

TEST(Rig, MendedTextIsToldInOneLine) {
  const Rig rig = read(vinsMono() + "max_cnt:150\nfreq: 10# Hz\nfreq: 20\n");
  ASSERT_EQ(rig.warnings.size(), 1u);
  EXPECT_TRUE(contains(rig.warnings[0], "mended as OpenCV reads it")) << rig.warnings[0];
}

TEST(Rig, ErrorsNameFileKeyAndWhatIsAllowed) {
  const std::string chain = chainCamera(0, bodyToCamera());
  const struct {
    std::string text, expected;
  } cases[] = {
      {replaced(vinsMono(), "td: -0.01", "td: 5"),
       "'td': found '5'; allowed: a number from -1 to 1"},
      {vinsMono() + "imu_noise_unit: percent\n", "allowed: auto, density, sample"},
      {replaced(vinsMono(), "estimate_extrinsic: 0", "estimate_extrinsic: 3"), "from 0 to 2"},
      {replaced(vinsMono(), "acc_n: 0.08\n", ""), "rig.yaml: key 'acc_n' is missing"},
      {replaced(vinsMono(), noise(), ""), "rig.yaml: key 'acc_n' is missing"},
      {replaced(vinsMono(), "acc_n: 0.08", "acc_n: -1"),
       "'acc_n': found '-1'; allowed: a number "
       "from 0 to 100"},
      {replaced(vinsMono(), "extrinsicTranslation", "extrinsicTranslatoin"),
       "has 'extrinsicTranslatoin': is that meant?"},
      {vinsMono() + "imu: 0\n", "needs an IMU"},
      {vinsMono() + "num_of_cam: 2\n", "key 'cam1_calib' is missing"},
      {vinsMono() + "image1_topic: /cam1/image_raw\n", "key 'cam1_calib' is missing"},
      {vinsMono() + "cam1_calib: {" + "}\nnum_of_cam: 2\n",
       "cam1_calib: key 'model_type' is missing"},
      {chain + "num_of_cam: 3\n" + chainCamera(1, firstToSecond()), "key 'cam2_calib' is missing"},
      {chain + chainCamera(1, ""), "key 'body_T_cam1' is missing"},
      {replaced(chain, "timeshift_cam_imu: 0.007", "timeshift_cam_imu: 7"),
       "'timeshift_cam_imu': found '7'"},
      {chain + "relative_config_imu: nowhere.yaml\n",
       "'relative_config_imu': found 'nowhere.yaml'"},
      {"imu_topic: /imu0\n", "key 'model_type' is missing"}};
  for (const auto& c : cases) {
    const std::string message = errorOf(c.text);
    EXPECT_TRUE(contains(message, c.expected)) << c.expected << "\n" << message;
    EXPECT_TRUE(contains(message, "rig.yaml")) << message;
  }
}

TEST(Rig, NeededTopicsAreAskedForByTheirKeys) {
  const Parameters parameters = Parameters::parse(
      replaced(replaced(vinsMono(), "imu_topic", "imu_tpic"), "image_topic", "imge_topic"),
      "rig.yaml");
  const Rig rig = readRig(parameters);
  EXPECT_THROW(requireImageTopic(parameters, rig), InputError);
  try {
    requireImuTopic(parameters, rig);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "'imu_topic' is missing")) << error.what();
    EXPECT_TRUE(contains(error.what(), "'imu_tpic': is that meant?")) << error.what();
  }
  EXPECT_EQ(configurationWarnings(parameters, rig).size(), 2u);
}

}  // namespace
}  // namespace vins::camera_model
