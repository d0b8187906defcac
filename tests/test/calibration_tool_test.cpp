// The calibration tool, run as a user runs it, on rendered images of every camera model.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "camera_model/camera_file.h"

namespace fs = std::filesystem;

namespace vins::tests {
namespace {

/// Programs of the build lie beside each other, a folder a package.
std::string program(const std::string& package, const std::string& name) {
  const fs::path own = fs::read_symlink("/proc/self/exe").parent_path();
  return (own.parent_path() / package / name).string();
}

struct Outcome {
  int exit_code = 0;
  std::string output;
};

Outcome run(const std::string& command) {
  const fs::path log = fs::path(::testing::TempDir()) / "calibration_tool_test.log";
  const int status = std::system((command + " > " + log.string() + " 2>&1").c_str());
  std::ifstream in(log);
  return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(in), {})};
}

const std::string kCalibrate = program("camera_model", "intrinsic_calibration");
const std::string kRender = program("vins_tests", "simulate_chessboard");

double focalLength(const camera_model::Camera& camera) {
  camera_model::ProjectionJacobians jacobians;
  camera.project({0.0, 0.0, 1.0}, &jacobians);
  return jacobians.J_pixel_point(0, 0);
}

class CalibrationTool : public ::testing::TestWithParam<std::string> {};

TEST_P(CalibrationTool, RecoversTheCameraFromRenderedImages) {
  const std::string camera_file = "../config/simulation/" + GetParam() + "_camera.yaml";
  const auto truth = camera_model::readCameraFile(camera_file);
  const fs::path folder = fs::path(::testing::TempDir()) / ("calibration_" + GetParam());
  fs::remove_all(folder);
  const Outcome rendered =
      run(kRender + " --camera " + camera_file + " -n 30 -o " + (folder / "images").string());
  ASSERT_EQ(rendered.exit_code, 0) << rendered.output;
  const Outcome calibrated =
      run(kCalibrate + " -w 9 -h 7 -s 40 -i " + (folder / "images").string() +
          " --prefix board -e .png" + (GetParam() == "ocam" ? "" : " --kalibr") +
          " --camera-model " + toString(truth->model()) + " --camera-name " + GetParam() + " -o " +
          (folder / "results").string());
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.output;

  const auto estimate = camera_model::readCameraFile(
      (folder / "results" / (GetParam() + "_camera_calib.yaml")).string());
  EXPECT_EQ(estimate->model(), truth->model());
  if (GetParam() != "ocam") {
    const auto kalibr = camera_model::readCameraFile(
        (folder / "results" / (GetParam() + "_camchain.yaml")).string());
    EXPECT_EQ(kalibr->parameters(), estimate->parameters());
  }
  EXPECT_EQ(estimate->imageSize(), truth->imageSize());
  EXPECT_NEAR(focalLength(*estimate), focalLength(*truth), 0.001 * focalLength(*truth));
  for (const char* name : {"_report.txt", "_coverage.png", "_residuals.png"}) {
    EXPECT_GT(fs::file_size(folder / "results" / (GetParam() + name)), 500u) << name;
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(AllModels, CalibrationTool,
                         ::testing::Values("pinhole", "fisheye", "omni", "ocam", "double_sphere",
                                           "eucm"),
                         [](const auto& info) { return info.param; });

TEST(CalibrationToolErrors, TellWhatToDo) {
  const struct {
    std::string arguments;
    std::string expected;
  } cases[] = {
      {"-i /nowhere", "/nowhere: is no folder"},
      {"-i ../config --prefix board", "no image 'board*.png' in it"},
      {"-w 2", "found 2 x 12 inner corners"},
      {"--camera-model fisheye", "found 'fisheye'; allowed: pinhole, kannala-brandt"},
      {"--kalibr --camera-model scaramuzza", "Kalibr has no form"},
      {"--focal 3", "unrecognised option '--focal'"},
  };
  for (const auto& c : cases) {
    const Outcome outcome = run(kCalibrate + " " + c.arguments);
    EXPECT_EQ(outcome.exit_code, 1) << c.arguments;
    EXPECT_NE(outcome.output.find(c.expected), std::string::npos) << outcome.output;
  }
  EXPECT_EQ(run(kCalibrate + " --help").exit_code, 0);
  EXPECT_EQ(run(kRender + " --help").exit_code, 0);
  EXPECT_EQ(run(kRender).exit_code, 1);
}

}  // namespace
}  // namespace vins::tests
