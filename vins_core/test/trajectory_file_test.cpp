#include "vins_core/trajectory_file.h"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins {
namespace {

Trajectory read(const std::string& text) {
  std::istringstream in(text);
  return readTrajectory(in, "gt.txt");
}

std::string errorOf(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TrajectoryFile, ReadsTum) {
  const Trajectory t = read(
      "# stamp x y z qx qy qz qw\n\n"
      "1403715273.26214 0.8 2.1 0.9 0 0 0.6 0.8\r\n"
      "1403715273.312140001 1 2 3 1 0 0 0 # landed\n");
  ASSERT_EQ(t.poses().size(), 2u);
  EXPECT_EQ(t.poses()[0].stamp, 1403715273262140000);
  EXPECT_EQ(t.poses()[1].stamp, 1403715273312140001);
  EXPECT_EQ(t.poses()[0].T_wb.position, Eigen::Vector3d(0.8, 2.1, 0.9));
  EXPECT_NEAR(t.poses()[0].T_wb.rotation.z(), 0.6, 1e-15);
  EXPECT_NEAR(t.poses()[0].T_wb.rotation.w(), 0.8, 1e-15);
}

TEST(TrajectoryFile, ReadsEurocCsv) {
  const Trajectory t = read(
      "#timestamp, p_RS_R_x [m], ...\n"
      "1403636580838555648,4.6,-1.7,0.8,0.8,0,0.6,0,0.1,0.2\n");
  EXPECT_EQ(t.poses().at(0).stamp, 1403636580838555648);
  EXPECT_NEAR(t.poses()[0].T_wb.rotation.y(), 0.6, 1e-15);
  EXPECT_EQ(t.poses()[0].T_wb.position.x(), 4.6);
}

TEST(TrajectoryFile, TumLineKeepsNanoseconds) {
  const StampedPose pose{1403636580838555648,
                         {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Eigen::Vector3d(1, -2, 0.125)}};
  const Trajectory t = read(toTumLine(pose));
  EXPECT_EQ(t.poses().at(0).stamp, pose.stamp);
  EXPECT_LT((t.poses()[0].T_wb.matrix() - pose.T_wb.matrix()).norm(), 1e-15);
}

TEST(TrajectoryFile, ErrorsNameFileAndLine) {
  EXPECT_EQ(errorOf("# only a comment\n"), "gt.txt: no pose in it");
  EXPECT_EQ(errorOf("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n"),
            "gt.txt:2: found 7 values where a stamp, a position and a quaternion (8) are needed");
  EXPECT_EQ(errorOf("1 0 nan 0 0 0 0 1\n"),
            "gt.txt:1: found 'nan' where a finite number is needed");
  EXPECT_EQ(errorOf("x 0 0 0 0 0 0 1\n"), "gt.txt:1: found 'x' where a stamp in seconds is needed");
  EXPECT_EQ(errorOf("1.5,0,0,0,1,0,0,0\n"), "gt.txt:1: found '1.5' where a stamp is needed");
  EXPECT_EQ(errorOf("9403636579758555392,0,0,0,1,0,0,0\n"),
            "gt.txt:1: found '9403636579758555392' where a stamp is needed");
  EXPECT_EQ(errorOf("1 0 0 0 0 0 0 2\n"),
            "gt.txt:1: found a quaternion of length 2.000000 where a unit quaternion is needed");
  EXPECT_EQ(errorOf("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
            "gt.txt:2: trajectory: stamp 1000000000 ns follows 2000000000 ns; stamps must rise");
  EXPECT_THROW(readTrajectoryFile("/nowhere/gt.txt"), InputError);
}

TEST(TrajectoryFile, ParsesSecondsExactly) {
  EXPECT_EQ(parseSeconds("1403715273.26214"), 1403715273262140000);
  EXPECT_EQ(parseSeconds("5"), 5000000000);
  EXPECT_EQ(parseSeconds("0.0000000019"), 1);
  for (const char* text : {"", ".", "-1", "1e9", "1.2.3", "12345678901.0", "9403715273.2"}) {
    EXPECT_THROW(parseSeconds(text), InputError) << text;
  }
}

}  // namespace
}  // namespace vins
