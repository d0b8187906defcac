#include "simulation/odometry_study.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "vins_core/input_error.h"
#include "vins_core/parameters.h"

namespace fs = std::filesystem;

namespace vins::simulation {
namespace {

OdometryStudyOptions shortFlight() {
  OdometryStudyOptions options;
  options.features.duration = 8.0;
  return options;
}

TEST(OdometryStudy, AFlightIsFollowed) {
  const OdometryRun run = runOdometry(shortFlight(), 1);
  EXPECT_EQ(run.frames, 161u);
  EXPECT_EQ(run.frame_seconds.size(), 161u);
  const OdometryFigures figures = evaluate(run);
  ASSERT_TRUE(figures.initialised);
  EXPECT_LT(figures.time_to_initialise, 5.0);
  // Far from what the estimator is held to elsewhere: frames, clocks and biases fit together.
  EXPECT_LT(figures.ate, 0.1);
  EXPECT_LT(figures.rotation_error, 0.03);
  EXPECT_LT((run.samples.back().estimate.state.v_w.norm() - run.samples.back().truth.v_w.norm()),
            0.2);
}

TEST(OdometryStudy, TheSameSeedGivesTheSameFlight) {
  OdometryStudyOptions options = shortFlight();
  options.features.duration = 3.0;
  const OdometryRun first = runOdometry(options, 3), second = runOdometry(options, 3);
  ASSERT_EQ(first.samples.size(), second.samples.size());
  for (std::size_t i = 0; i < first.samples.size(); ++i) {
    EXPECT_EQ(first.samples[i].estimate.state.T_wb.position,
              second.samples[i].estimate.state.T_wb.position);
  }
}

TEST(OdometryStudy, RefusesBadOptions) {
  OdometryStudyOptions options;
  options.trajectory = "loop";
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.imu_noise = "much";
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.estimator.window_size = 1;
  EXPECT_THROW(options.validate(), InputError);
}

struct Outcome {
  int exit_code = 0;
  std::string output;
};

Outcome runTool(const std::string& arguments) {
  const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "simulate_odometry";
  const fs::path log = fs::path(::testing::TempDir()) / "odometry_study_test.log";
  const int status =
      std::system((tool.string() + " " + arguments + " > " + log.string() + " 2>&1").c_str());
  std::ifstream in(log);
  return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(in), {})};
}

TEST(SimulateOdometry, PrintsATableAndWritesJson) {
  const std::string json = ::testing::TempDir() + "odometry_study_test.json";
  // Too few features to start from: the exit code tells.
  const Outcome outcome =
      runTool("--duration 1 --features 5 --seeds 2 --first-seed 5 --json " + json);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("0 of 2 runs initialised"), std::string::npos) << outcome.output;
  const Parameters figures = Parameters::load(json);
  EXPECT_FALSE(figures.section("mean").flag("initialised"));
  fs::remove(json);
}

TEST(SimulateOdometry, ErrorsTellWhatIsAllowed) {
  Outcome outcome = runTool("--trajectory loop");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("found 'loop'; allowed: a file, hall_loop"), std::string::npos)
      << outcome.output;
  outcome = runTool("--window-size 2");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("window_size is 2; allowed: 4 to 30"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(runTool("--help").exit_code, 0);
}

}  // namespace
}  // namespace vins::simulation
