#include "camera_model/camera_file.h"

#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "camera_model/testing/example_cameras.h"
#include "vins_core/input_error.h"
#include "vins_core/text_file.h"

namespace vins::camera_model {
namespace {

using testing::parametersOf;

constexpr char kVinsMono[] = R"(%YAML:1.0

#common parameters
imu_topic: "/imu0"
image_topic: "/cam0/image_raw"

#camera calibration
model_type: PINHOLE
camera_name: camera
image_width: 752
image_height: 480
distortion_parameters:
   k1: -2.917e-01
   k2: 8.228e-02
   p1: 5.333e-05
   p2: -1.578e-04
projection_parameters:
   fx: 4.616e+02
   fy: 4.603e+02
   cx: 3.630e+02
   cy: 2.481e+02
max_cnt: 150
)";

constexpr char kKalibr[] = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [0.0034, 0.0007, -0.002, 0.0002]
  distortion_model: equidistant
  intrinsics: [190.9, 190.8, 254.9, 256.8]
  resolution: [512, 512]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.1]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: omni
  distortion_coeffs: [-0.33, 0.13, 0.0005, 0.0006]
  distortion_model: radtan
  intrinsics: [0.8, 833.0, 830.3, 373.8, 253.7]
  resolution: [752, 480]
)";

std::unique_ptr<Camera> read(const std::string& text, const std::string& camera = "cam0") {
  return readCamera(Parameters::parse(text, "rig.yaml"), camera);
}

std::string errorOf(const std::string& text, const std::string& camera = "cam0") {
  try {
    read(text, camera);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(CameraFile, ReadsTheCameraOutOfAVinsMonoConfiguration) {
  const auto camera = read(kVinsMono);
  EXPECT_EQ(camera->model(), CameraModel::kPinhole);
  EXPECT_EQ(camera->imageSize(), (ImageSize{752, 480}));
  EXPECT_EQ(camera->parameters(), parametersOf({461.6, 460.3, 363.0, 248.1, -0.2917, 0.08228,
                                                5.333e-05, -1.578e-04, 0.0}));
}

TEST(CameraFile, ReadsKalibrCamchains) {
  const auto fisheye = read(kKalibr);
  EXPECT_EQ(fisheye->model(), CameraModel::kKannalaBrandt);
  EXPECT_EQ(fisheye->parameters(),
            parametersOf({0.0034, 0.0007, -0.002, 0.0002, 190.9, 190.8, 254.9, 256.8}));
  const auto omni = read(kKalibr, "cam1");
  EXPECT_EQ(omni->model(), CameraModel::kMei);
  EXPECT_EQ(omni->imageSize(), (ImageSize{752, 480}));
  EXPECT_EQ(omni->parameters(),
            parametersOf({0.8, -0.33, 0.13, 0.0005, 0.0006, 833.0, 830.3, 373.8, 253.7}));
}

TEST(CameraFile, ReadsKalibrsDoubleSphereAndUnifiedCameras) {
  const auto read_unified = [](const std::string& model, const std::string& intrinsics) {
    return read("cam0:\n  camera_model: " + model + "\n  intrinsics: " + intrinsics +
                "\n  distortion_model: none\n  distortion_coeffs: []\n  resolution: [752, 480]\n");
  };
  const auto ds = read_unified("ds", "[-0.2, 0.59, 317.5, 316.1, 367, 248]");
  EXPECT_EQ(ds->model(), CameraModel::kDoubleSphere);
  EXPECT_EQ(ds->parameters(), parametersOf({-0.2, 0.59, 317.5, 316.1, 367, 248}));
  EXPECT_EQ(read_unified("eucm", "[0.6, 1.1, 317.5, 316.1, 367, 248]")->model(),
            CameraModel::kEucm);
}

TEST(CameraFile, RefusesAResolutionThatIsNoImagesSize) {
  for (const std::string resolution : {"[4e100, 480]", "[752, 0]", "[-752, 480]"}) {
    const std::string text =
        "cam0:\n  camera_model: eucm\n  intrinsics: [0.6, 1.1, 317.5, 316.1, 367, 248]\n"
        "  distortion_model: none\n  distortion_coeffs: []\n  resolution: " +
        resolution + "\n";
    try {
      read(text);
      FAIL() << resolution;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("key 'resolution'"), std::string::npos)
          << error.what();
    }
  }
}

TEST(CameraFile, ReadsK3InKalibrsForm) {
  const std::string text = replaced(kKalibr, "[0.0034, 0.0007, -0.002, 0.0002]",
                                    "[0.0034, 0.0007, -0.002, 0.0002, 0.03]");
  EXPECT_EQ(read(replaced(text, "equidistant", "radtan"))->parameters()[8], 0.03);
  EXPECT_NE(errorOf(text), "") << "equidistant has four";
}

TEST(CameraFile, CamodocalFormRoundTripsExactly) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const auto back = read(toCamodocalYaml(*camera));
    EXPECT_EQ(back->model(), camera->model());
    EXPECT_EQ(back->name(), camera->name());
    EXPECT_EQ(back->imageSize(), camera->imageSize());
    EXPECT_EQ(back->parameters(), camera->parameters());
  }
}

TEST(CameraFile, KalibrFormRoundTripsExactly) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    if (camera->model() == CameraModel::kScaramuzza) continue;
    const auto back = read(toKalibrYaml(*camera, "cam3"), "cam3");
    EXPECT_EQ(back->model(), camera->model());
    EXPECT_EQ(back->parameters(), camera->parameters());
  }
}

TEST(CameraFile, RefusesToWriteWhatKalibrHasNoFormFor) {
  EXPECT_THROW(toKalibrYaml(*vins::camera_model::testing::exampleCameras()[3]), InputError);
  CameraParameters p = vins::camera_model::testing::exampleCameras()[0]->parameters();
  p[8] = 0.01;
  EXPECT_THROW(toKalibrYaml(*vins::camera_model::testing::exampleCameras()[0]->withParameters(p)),
               InputError);
}

TEST(CameraFile, KeepsK3) {
  CameraParameters p = vins::camera_model::testing::exampleCameras()[0]->parameters();
  p[8] = 0.0123;
  const auto camera = vins::camera_model::testing::exampleCameras()[0]->withParameters(p);
  EXPECT_EQ(read(toCamodocalYaml(*camera))->parameters(), p);
}

TEST(CameraFile, RationalDistortionRoundTripsExactly) {
  const CameraParameters p =
      parametersOf({504, 505, 321, 238, 0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43});
  const PinholeRadtan camera("rational", {640, 480}, p);
  EXPECT_EQ(read(toCamodocalYaml(camera))->parameters(), p);
  EXPECT_THROW(toKalibrYaml(camera), InputError);
}

TEST(CameraFile, ReadsTheEightCoefficientsOfOpenCv) {
  const std::string text = replaced(replaced(kKalibr, "[0.0034, 0.0007, -0.002, 0.0002]",
                                             "[0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43]"),
                                    "equidistant", "radtan");
  EXPECT_EQ(read(text)->parameters(), parametersOf({190.9, 190.8, 254.9, 256.8, 0.5, -2.6, 3e-3,
                                                    -2e-3, 1.5, 0.39, -2.4, 1.43}));
  // Zeros are no denominator: nine parameters are left.
  const std::string zeros = replaced(text, "0.39, -2.4, 1.43", "0, 0, 0");
  EXPECT_EQ(read(zeros)->parameters().size(), 9);
}

TEST(CameraFile, WritesWhatOpencvsReaderReads) {
  // VINS-Mono and camodocal read by cv::FileStorage.
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const cv::FileStorage storage(toCamodocalYaml(*camera),
                                  cv::FileStorage::READ | cv::FileStorage::MEMORY);
    EXPECT_EQ(static_cast<std::string>(storage["model_type"]), toString(camera->model()));
    EXPECT_EQ(static_cast<int>(storage["image_width"]), camera->imageSize().width);
    const char* section =
        camera->model() == CameraModel::kScaramuzza ? "affine_parameters" : "projection_parameters";
    const cv::FileNode node = storage[section];
    const auto names = camera->parameterNames();
    const CameraParameters p = camera->parameters();
    int found = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (node[names[i]].empty()) continue;
      ++found;
      EXPECT_DOUBLE_EQ(static_cast<double>(node[names[i]]), p[static_cast<int>(i)]) << names[i];
    }
    EXPECT_GE(found, 4);
  }
}

TEST(CameraFile, OcamsInversePolynomialIsNearTheInverse) {
  const auto cameras = vins::camera_model::testing::exampleCameras();
  const auto& camera = static_cast<const Scaramuzza&>(*cameras[3]);
  const std::vector<double> c = camera.fitInversePolynomial(14);
  for (double u = 10.0; u < 790.0; u += 20.0) {
    const Eigen::Vector3d b = *camera.unproject({u, 400.0});
    const double angle = std::atan2(-b.z(), b.head<2>().norm());
    double radius = 0.0;
    for (std::size_t i = c.size(); i-- > 0;) radius = radius * angle + c[i];
    EXPECT_NEAR(radius, std::hypot((u - 402.0 - 3.0 * 0.0003) / 1.0002, 3.0), 0.01);
  }
}

TEST(CameraFile, ErrorsNameFileKeyFoundAndAllowed) {
  EXPECT_EQ(
      errorOf(replaced(kVinsMono, "PINHOLE", "PINWHEEL")),
      "rig.yaml:8: key 'model_type': found 'PINWHEEL'; allowed: PINHOLE, KANNALA_BRANDT, MEI, "
      "SCARAMUZZA, DOUBLE_SPHERE, EUCM");
  EXPECT_EQ(errorOf(replaced(kVinsMono, "fx: 4.616e+02", "f_x: 4.616e+02")),
            "rig.yaml: projection_parameters: key 'fx' is missing; allowed: a number; line 18 has "
            "'f_x': is that meant?");
  EXPECT_EQ(errorOf(replaced(kVinsMono, "4.616e+02", "-4.616e+02")),
            "rig.yaml: camera 'camera': fx: found -461.600000; allowed: a number above 0");
  EXPECT_EQ(errorOf(replaced(kVinsMono, "752", "0")),
            "rig.yaml:10: key 'image_width': found '0'; allowed: a whole number from 1 to 100000");
  EXPECT_EQ(errorOf(replaced(kKalibr, "pinhole", "fov")),
            "rig.yaml:3: key 'camera_model': found 'fov'; allowed: pinhole, omni, ds, eucm");
  EXPECT_EQ(errorOf(replaced(kKalibr, "equidistant", "fov")),
            "rig.yaml:5: key 'distortion_model': found 'fov'; allowed: radtan, equidistant, none");
  EXPECT_EQ(errorOf("imu_topic: /imu0\n"),
            "rig.yaml: key 'model_type' is missing; allowed: PINHOLE, KANNALA_BRANDT, MEI, "
            "SCARAMUZZA, DOUBLE_SPHERE, EUCM");
}

TEST(CameraFile, ReadsFromDisk) {
  const std::string path = ::testing::TempDir() + "camera_file_test.yaml";
  writeTextFile(path, kKalibr);
  EXPECT_EQ(readCameraFile(path, "cam1")->model(), CameraModel::kMei);
  std::remove(path.c_str());
  EXPECT_THROW(readCameraFile(path), InputError);
}

}  // namespace
}  // namespace vins::camera_model
