#include "pose_graph/map/g2o_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "noisy_sphere.h"
#include "pose_graph/graph/six_dof.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/testing/shared_data.h"

namespace vins::pose_graph {
namespace {

G2oFile parse(const std::string& text) {
  std::istringstream in(text);
  return readG2o(in, "graph.g2o");
}

std::string messageOf(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const std::string kPoses =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 1 1 2 3 0 0 0.6 0.8\r\n";
const std::string kIdentity = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n";

TEST(G2oFile, ReadsPosesEdgesAndWhatIsFixed) {
  const G2oFile file =
      parse("# a comment\n\n" + kPoses + "FIX 1\nEDGE_SE3:QUAT 0 1 1 2 3 0 0 0 1" + kIdentity);
  ASSERT_EQ(file.graph.poses.size(), 2u);
  EXPECT_FALSE(file.graph.planar);
  EXPECT_FALSE(file.graph.poses[0].fixed);
  EXPECT_TRUE(file.graph.poses[1].fixed);
  EXPECT_EQ(file.graph.poses[1].T_wi.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(so3::log(file.graph.poses[1].T_wi.rotation).z(), 2.0 * std::asin(0.6), 1e-15);
}

TEST(G2oFile, InformationIsTheUpperTriangleRowByRow) {
  const G2oFile file = parse(kPoses + "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0 1 " +
                             "101 2 3 4 5 6 102 7 8 9 10 103 11 12 13 104 14 15 105 16 106\n");
  const auto& A = file.graph.edges[0].information;
  EXPECT_EQ(A(0, 5), 6.0);
  EXPECT_EQ(A(1, 1), 102.0);
  EXPECT_EQ(A(2, 3), 11.0);
  EXPECT_EQ(A(5, 4), 16.0);
  EXPECT_EQ(A, A.transpose());
  const G2oFile planar =
      parse("VERTEX_SE2 3 1 2 0.5\nVERTEX_SE2 4 0 0 0\nEDGE_SE2 3 4 1 2 0.5 101 2 3 102 4 103\n");
  const auto& B = planar.graph.edges[0].information;
  EXPECT_TRUE(planar.graph.planar);
  EXPECT_EQ(B(0, 1), 2.0);
  EXPECT_EQ(B(5, 0), 3.0);
  EXPECT_EQ(B(1, 5), 4.0);
  EXPECT_EQ(B(5, 5), 103.0);
}

TEST(G2oFile, WritesWhatItReads) {
  for (const bool planar : {false, true}) {
    G2oFile file;
    file.graph = testing::noisySphere(3, 8, 0.1, planar, 1);
    file.graph.poses[4].fixed = true;
    file.other_lines = {"VERTEX_XY 100 1.0 2.0"};
    const G2oFile copy = parse(toG2o(file));
    ASSERT_EQ(copy.graph.poses.size(), file.graph.poses.size());
    ASSERT_EQ(copy.graph.edges.size(), file.graph.edges.size());
    EXPECT_EQ(copy.graph.planar, planar);
    EXPECT_EQ(copy.other_lines, file.other_lines);
    for (std::size_t i = 0; i < copy.graph.poses.size(); ++i) {
      const GraphPose &a = copy.graph.poses[i], &b = file.graph.poses[i];
      EXPECT_EQ(a.fixed, b.fixed);
      EXPECT_EQ(a.T_wi.position, b.T_wi.position);
      // A quaternion is normalized anew, or passes through an angle: its last digit may change.
      EXPECT_LT(a.T_wi.rotation.angularDistance(b.T_wi.rotation), 1e-15);
    }
    for (std::size_t k = 0; k < copy.graph.edges.size(); ++k) {
      const RelativePoseEdge &a = copy.graph.edges[k], &b = file.graph.edges[k];
      EXPECT_EQ(a.T_ij.position, b.T_ij.position);
      for (const int element : {0, 1, 5}) {
        EXPECT_EQ(a.information(element, element), b.information(element, element));
      }
    }
  }
}

TEST(G2oFile, UnknownTagsAreKeptAndNamedOnce) {
  const G2oFile file = parse("PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n" + kPoses +
                             "EDGE_SE2_XY 0 7 1 1\n" + "EDGE_SE2_XY 0 8 1 1\n");
  EXPECT_EQ(file.other_lines.size(), 3u);
  ASSERT_EQ(file.warnings.size(), 2u);
  EXPECT_EQ(file.warnings[1].find("graph.g2o:4: unknown tag 'EDGE_SE2_XY'"), 0u)
      << file.warnings[1];
}

TEST(G2oFile, BadLinesAreNamedByFileAndLine) {
  const std::string edge = "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "graph.g2o: no pose in it"},
      {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0\n", "graph.g2o:1: found the end of the line"},
      {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1 5\n", "graph.g2o:1: found '5' after the last value"},
      {"VERTEX_SE3:QUAT 0 0 zero 0 0 0 0 1\n", "graph.g2o:1: found 'zero'"},
      {"VERTEX_SE3:QUAT 0 0 nan 0 0 0 0 1\n", "graph.g2o:1: found 'nan'"},
      {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0.5\n", "graph.g2o:1: found a quaternion of length 0.5"},
      {"VERTEX_SE3:QUAT -1 0 0 0 0 0 0 1\n", "graph.g2o:1: found '-1' where an id"},
      {kPoses + "VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", "graph.g2o:3: found pose 1 for the second"},
      {kPoses + "VERTEX_SE2 2 0 0 0\n", "graph.g2o:3: found SE(2) and SE(3)"},
      {kPoses + "EDGE_SE3:QUAT 0 7 0 0 0 0 0 0 1" + kIdentity, "graph.g2o:3: found pose 7"},
      {kPoses + "EDGE_SE3:QUAT 1 1 0 0 0 0 0 0 1" + kIdentity, "graph.g2o:3: found an edge"},
      {kPoses + edge + " -1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
       "graph.g2o:3: found an information matrix"},
      {kPoses + edge + " 1 0 0\n", "graph.g2o:3: found the end of the line"},
      {kPoses + "FIX 9\n", "graph.g2o:3: found pose 9"},
      {kPoses + "FIX\n", "graph.g2o:3: found the end of the line"},
  };
  for (const auto& [text, message] : cases) {
    EXPECT_EQ(messageOf(text).find(message), 0u) << messageOf(text) << "\nexpected: " << message;
  }
  EXPECT_THROW(readG2oFile("/no/such/file.g2o"), InputError);
}

TEST(G2oFile, WritesAsideAndLeavesNoHalfFile) {
  const auto folder = std::filesystem::path(::testing::TempDir());
  G2oFile file;
  file.graph = testing::noisySphere(2, 8, 0.1, false, 2);
  const std::string path = (folder / "g2o_file_test.g2o").string();
  writeG2oFile(path, file);
  EXPECT_EQ(readG2oFile(path).graph.edges.size(), file.graph.edges.size());
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  std::filesystem::remove(path);
  EXPECT_THROW(writeG2oFile("/dev/null/out.g2o", file), InputError);
}

/// Files as they are found in the wild, small enough for a test.
TEST(G2oFile, PublishedGraphsReachTheirKnownCost) {
  const std::string garage = vins::testing::sharedData("g2o/parking-garage.g2o");
  VINS_SKIP_WITHOUT(garage);
  G2oFile file = readG2oFile(garage);
  EXPECT_EQ(file.graph.poses.size(), 1661u);
  EXPECT_EQ(file.graph.edges.size(), 6275u);
  EXPECT_TRUE(file.warnings.empty());
  SixDofOptions options;
  options.minimizer.method = MinimizerMethod::kGaussNewton;
  const MinimizerSummary summary = optimizeSixDof(&file.graph, options);
  EXPECT_EQ(summary.status, MinimizerStatus::kConverged);
  // The lowest cost that is known, to the digits given here.
  EXPECT_NEAR(summary.final_cost, 0.63419, 1e-4);
}

}  // namespace
}  // namespace vins::pose_graph
