// measure_tracks, run as a user runs it.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "vins_core/testing/shared_data.h"

namespace fs = std::filesystem;

namespace vins::tests {
namespace {

int measure(const std::string& arguments, std::string* output) {
  const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "measure_tracks";
  const std::string log = ::testing::TempDir() + "/measure_tracks.txt";
  const int status = std::system((tool.string() + " " + arguments + " > " + log + " 2>&1").c_str());
  std::ifstream in(log);
  *output = std::string(std::istreambuf_iterator<char>(in), {});
  return WEXITSTATUS(status);
}

TEST(MeasureTracks, RefusesWhatIsNotThere) {
  std::string output;
  EXPECT_EQ(measure("no_such_rig.yaml no_such.bag", &output), 1);
  EXPECT_NE(output.find("no_such_rig.yaml"), std::string::npos) << output;
}

TEST(MeasureTracks, CountsTheTracksOfBothFrontEndsInEachSpan) {
  const std::string recording = vins::testing::sharedData("euroc_mh01_flight");
  VINS_SKIP_WITHOUT(recording);
  std::string output;
  const std::string arguments =
      "../config/euroc/euroc_config.yaml " + recording + " --duration 4 --split 2";
  ASSERT_EQ(measure(arguments, &output), 0) << output;
  std::istringstream lines(output);
  std::string line;
  int spans = 0;
  while (std::getline(lines, line)) {
    const std::size_t name = line.find("this project");
    if (name == std::string::npos) continue;
    ++spans;
    std::istringstream figures(line.substr(name + std::string("this project").size()));
    double images = 0.0, tracks = 0.0, followed = 0.0;
    figures >> images >> tracks >> followed;
    EXPECT_GE(images, 20.0);
    EXPECT_LE(followed, tracks);
    EXPECT_GT(followed, 75.0);
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_NE(line.find("GFTT + KLT"), std::string::npos) << line;
  }
  EXPECT_EQ(spans, 2);
}

}  // namespace
}  // namespace vins::tests
