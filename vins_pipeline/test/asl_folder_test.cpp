#include "vins_pipeline/asl_folder.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"
#include "vins_core/testing/shared_data.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

void writeFile(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// A small recording in a folder of its own, made before each test.
class AslFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    parent_ = fs::path(::testing::TempDir()) / "asl_folder_test" / test->name();
    fs::remove_all(parent_);
    mav_ = parent_ / "MH_01" / "mav0";
    writeFile(mav_ / "cam0" / "data.csv",
              "#timestamp [ns],filename\n1403636579763555584,a.png\n1403636579813555456,b.png\n");
    writeFile(mav_ / "cam0" / "data" / "a.png", "image");
    writeFile(mav_ / "cam0" / "data" / "b.png", "image");
    writeFile(mav_ / "imu0" / "data.csv",
              "#timestamp,w,w,w,a,a,a\r\n1403636579758555392,-0.1,0.2,0.3,8.1,-0.4,-2.6\r\n"
              "1403636579763555584, 0.1, 0.2, 0.3, 8.2, 0.4, 2.6\r\n");
  }
  void TearDown() override { fs::remove_all(parent_); }

  /// The message of the error that reading gives.
  std::string error() const {
    try {
      readAslFolder(mav_.string());
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::string path(const char* file) const { return (mav_ / file).string(); }

  fs::path parent_, mav_;
};

TEST_F(AslFolder, IsReadWithExactStamps) {
  const AslRecording recording = readAslFolder(mav_.string());
  ASSERT_EQ(recording.cameras.size(), 1u);
  ASSERT_EQ(recording.cameras[0].size(), 2u);
  EXPECT_EQ(recording.cameras[0][0].stamp, 1403636579763555584);
  EXPECT_EQ(recording.cameras[0][1].path, path("cam0/data/b.png"));
  ASSERT_EQ(recording.imu.size(), 2u);
  EXPECT_EQ(recording.imu[0].stamp, 1403636579758555392);
  EXPECT_EQ(recording.imu[0].angular_velocity, Eigen::Vector3d(-0.1, 0.2, 0.3));
  EXPECT_EQ(recording.imu[1].acceleration, Eigen::Vector3d(8.2, 0.4, 2.6));
  EXPECT_TRUE(recording.ground_truth.empty());
}

TEST_F(AslFolder, IsFoundFromItselfAndFromTheTwoFoldersAbove) {
  for (const fs::path& path : {mav_, mav_.parent_path(), parent_}) {
    EXPECT_EQ(readAslFolder(path.string()).folder, mav_.string()) << path;
  }
  writeFile(parent_ / "MH_02" / "mav0" / "imu0" / "data.csv", "");
  EXPECT_THROW(readAslFolder(parent_.string()), InputError);
}

TEST_F(AslFolder, GroundTruthIsTheStateElseViconElseLeica) {
  writeFile(mav_ / "leica0" / "data.csv", "#t,x,y,z\n1403636579763555584,1.5,2.5,3.5\n");
  AslRecording recording = readAslFolder(mav_.string());
  EXPECT_EQ(recording.ground_truth_source, "leica0");
  EXPECT_EQ(recording.ground_truth.poses().front().T_wb.position, Eigen::Vector3d(1.5, 2.5, 3.5));
  writeFile(mav_ / "vicon0" / "data.csv", "1403636579763555584,1,2,3,0,1,0,0\n");
  recording = readAslFolder(mav_.string());
  EXPECT_EQ(recording.ground_truth_source, "vicon0");
  EXPECT_EQ(recording.ground_truth.poses().front().T_wb.rotation.x(), 1.0);
  writeFile(mav_ / "state_groundtruth_estimate0" / "data.csv",
            "1403636579763555584,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(readAslFolder(mav_.string()).ground_truth_source, "state_groundtruth_estimate0");
}

TEST_F(AslFolder, ASecondCameraIsReadWhereItIsThere) {
  writeFile(mav_ / "cam1" / "data.csv", "1403636579763555584,c.png\n");
  writeFile(mav_ / "cam1" / "data" / "c.png", "image");
  EXPECT_EQ(readAslFolder(mav_.string()).cameras.at(1).at(0).path, path("cam1/data/c.png"));
}

TEST_F(AslFolder, ErrorsNameFileAndLine) {
  const struct {
    const char* file;
    const char* text;
    const char* expected;
  } cases[] = {
      {"imu0/data.csv", "#t\n20,0,0,0,0,0,0\n10,0,0,0,0,0,0\n",
       ":3: stamp 10 ns follows 20 ns; stamps must rise"},
      {"imu0/data.csv", "20,0,0,0,0,0,0\n20,0,0,0,0,0,0\n", ":2: stamp 20 ns follows 20 ns"},
      {"imu0/data.csv", "20,0,x,0,0,0,0\n", ":1: found 'x' where a finite number is needed"},
      {"imu0/data.csv", "20,0,nan,0,0,0,0\n", ":1: found 'nan'"},
      {"imu0/data.csv", "20,0,0,0,0,\n", ":1: found 5 values behind the stamp; 6 are needed"},
      {"imu0/data.csv", "1.5e9,0,0,0,0,0,0\n", ":1: found '1.5e9' where a stamp"},
      {"imu0/data.csv", "99999999999999999999,0,0,0,0,0,0\n", ":1: found '9999999"},
      {"imu0/data.csv", "# nothing\n", ": no data in it"},
      {"cam0/data.csv", "10,a.png\n20,lost.png\n", ":2: image file '"},
      {"cam0/data.csv", "10\n", ":1: found 0 values behind the stamp; 1 are needed"},
      {"cam0/data.csv", "10,\n", ":1: image file '"},
      {"leica0/data.csv", "10,1,2\n", ":1: found 2 values behind the stamp; 3 are needed"},
      {"vicon0/data.csv", "10,1,2,3,9,0,0,0\n", ":1: found a quaternion of length 9"},
  };
  for (const auto& c : cases) {
    SetUp();
    writeFile(mav_ / c.file, c.text);
    EXPECT_NE(error().find(path(c.file) + c.expected), std::string::npos)
        << error() << "\nfor " << c.text;
  }
}

TEST_F(AslFolder, MissingImagesAreSkippedAndNamedOnDemand) {
  fs::remove(mav_ / "cam0" / "data" / "a.png");
  EXPECT_NE(error().find("a.png' is missing"), std::string::npos) << error();
  const AslRecording recording = readAslFolder(mav_.string(), MissingImages::kSkip);
  EXPECT_EQ(recording.cameras[0].size(), 1u);
  ASSERT_EQ(recording.missing_images.size(), 1u);
  EXPECT_EQ(recording.missing_images[0], path("cam0/data/a.png"));
}

TEST_F(AslFolder, MissingFilesAndFoldersAreNamed) {
  fs::remove(mav_ / "imu0" / "data.csv");
  EXPECT_NE(error().find(path("imu0/data.csv") + ": cannot be opened"), std::string::npos);
  fs::remove_all(mav_ / "cam0");
  fs::remove_all(mav_ / "imu0");
  EXPECT_NE(error().find("found no recording"), std::string::npos) << error();
  fs::remove_all(parent_);
  EXPECT_NE(error().find("is no folder"), std::string::npos) << error();
}

TEST(AslFolderOfEuroc, IsReadWhole) {
  const std::string path = vins::testing::sharedData("euroc_v101_micro");
  VINS_SKIP_WITHOUT(path);
  // This copy lists four images of cam1 that are not there.
  const AslRecording recording = readAslFolder(path, MissingImages::kSkip);
  ASSERT_EQ(recording.cameras.size(), 2u);
  EXPECT_EQ(recording.cameras[0].size(), 95u);
  EXPECT_EQ(recording.cameras[1].size() + recording.missing_images.size(), 99u);
  EXPECT_EQ(recording.imu.size(), 1141u);
  EXPECT_EQ(recording.imu.front().stamp, 1403715273262142976);
  EXPECT_EQ(recording.ground_truth.poses().size(), 933u);
}

}  // namespace
}  // namespace vins::pipeline
