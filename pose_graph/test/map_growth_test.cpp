// The program map_growth, run as a user runs it: a short walk whose map fills up.

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "temp_folder.h"

namespace vins::pose_graph {
namespace {

int run(const std::string& arguments) {
  const auto tool = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "map_growth";
  return std::system((tool.string() + " " + arguments + " > /dev/null 2>&1").c_str());
}

/// Rows of numbers, without the head.
std::vector<std::vector<double>> tableOf(const std::string& path) {
  std::vector<std::vector<double>> table;
  std::istringstream lines(testing::bytesOf(path));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    table.emplace_back();
    std::istringstream numbers(line);
    for (std::string number; std::getline(numbers, number, ',');) {
      table.back().push_back(std::stod(number));
    }
  }
  return table;
}

TEST(MapGrowth, IsFlatOnceTheMapIsFull) {
  const testing::TempFolder folder("map_growth_test");
  // Rounds of 72 s; 200 keyframes are those of 100 s, so the second round fills the map.
  ASSERT_EQ(run("--csv " + folder.file("a.csv") + " --map " + folder.file("a.map") +
                " --seconds 240 --row 40 --lap 100 --max-keyframes 200"),
            0);
  const auto table = tableOf(folder.file("a.csv"));
  ASSERT_EQ(table.size(), 6u);
  for (const auto& row : table) {
    ASSERT_EQ(row.size(), 15u);
    EXPECT_LE(row[2], 200.0) << "keyframes";
    EXPECT_LE(row[3], 51.0) << "loops: one for four keyframes, and the one just found";
  }
  EXPECT_GT(table[3][3], 0.0) << "the second round is recognised";
  EXPECT_GT(table[5][4], 0.0) << "keyframes have left";
  // Full, the map holds 190 to 200 keyframes of the same size.
  EXPECT_NEAR(table[5][6], table[3][6], 0.15 * table[3][6]) << "memory of the graph";
  EXPECT_NEAR(table[5][12], table[3][12], 0.15 * table[3][12]) << "size of the file";
  // The odometry drifts by some centimetres a round, and loops hold it.
  EXPECT_LT(table[5][14], 0.3) << "position error [m]";
}

TEST(MapGrowth, StandingStillAddsNextToNothing) {
  const testing::TempFolder folder("map_growth_still_test");
  ASSERT_EQ(run("--csv " + folder.file("a.csv") + " --map " + folder.file("a.map") +
                " --seconds 300 --row 100 --speed 0 --sway 0.06"),
            0);
  const auto table = tableOf(folder.file("a.csv"));
  ASSERT_EQ(table.size(), 3u);
  // Of 600 keyframes few show anything new: the body sways by 6 cm and some degrees, and loops take
  // back what the odometry slips.
  EXPECT_LE(table[2][2], 80.0) << "keyframes";
  EXPECT_LE(table[2][2] - table[1][2], 0.5 * table[0][2]) << "ever fewer";
}

TEST(MapGrowth, BadOptionsAreTold) {
  EXPECT_NE(run("--csv a.csv"), 0);
  EXPECT_NE(run("--csv a.csv --map a.map --row 0"), 0);
  EXPECT_EQ(run("--help"), 0);
}

}  // namespace
}  // namespace vins::pose_graph
