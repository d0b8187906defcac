// Loop closing on a simulated flight, with the programs as a user runs them.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "simulation/euroc_rig.h"
#include "vins_core/heading.h"
#include "vins_core/trajectory_file.h"

namespace fs = std::filesystem;

namespace vins::tests {
namespace {

std::string textOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A loop as events.csv tells of it.
struct ToldLoop {
  Stamp stamp = 0;
  std::map<std::string, double> figures;
};

/// Poses of a camera that flies twice round a circle in one half of the hall and then once round
/// one in the other half, looking ahead, in 45 s (TUM).
void writeTwoCircles(const fs::path& path) {
  constexpr double kRadius = 2.4, kSpeed = 1.0;  // [m], [m/s]
  constexpr double kRound = 2.0 * M_PI * kRadius / kSpeed;
  const Eigen::Matrix3d R_wc_ahead =
      (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();  // along the world's x
  std::string text;
  for (double t = 0.0; t < 3.0 * kRound; t += 0.05) {
    const bool is_first = t < 2.0 * kRound;
    // The circles touch at the origin, where both fly along y.
    const double angle = t * kSpeed / kRadius * (is_first ? 1.0 : -1.0) + (is_first ? 0.0 : M_PI);
    const Eigen::Vector3d p((is_first ? -kRadius : kRadius) + kRadius * std::cos(angle),
                            kRadius * std::sin(angle), 1.7 + 0.1 * std::sin(2.0 * t));
    const double heading = angle + (is_first ? 0.5 : -0.5) * M_PI;
    const Eigen::Quaterniond R_wc(yawRotation(heading) * Eigen::Quaterniond(R_wc_ahead));
    const Pose T_wb = Pose(R_wc, p) * simulation::eurocCameraInBody(0).inverse();
    text += toTumLine({1600000000000000000 + toNanoseconds(t), T_wb}) + "\n";
  }
  std::ofstream(path) << text;
}

/// Two rounds through a hall in 40 s; a small image and half the rate, so that it takes not long.
class LoopClosing : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::create_directories(folder());
    std::ofstream(folder() / "camera.yaml")
        << "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: small\nimage_width: 376\n"
           "image_height: 240\ndistortion_parameters: {k1: 0, k2: 0, p1: 0, p2: 0}\n"
           "projection_parameters: {fx: 229.0, fy: 229.0, cx: 188.0, cy: 120.0}\n";
    run("vins_tests/simulate_bag", "-o " + (folder() / "hall.bag").string() +
                                       " --trajectory hall_loop --duration 40 --rate 10 --camera " +
                                       (folder() / "camera.yaml").string());
    // A small image has room for enough tracks only where they may be close.
    std::string rig = textOf(folder() / "hall_rig.yaml");
    rig.replace(rig.find("min_dist: 30"), 12, "min_dist: 15");
    std::ofstream(folder() / "hall_rig.yaml") << rig;
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }

  /// Of this process: the test may run twice at a time on one machine.
  static fs::path folder() {
    return fs::path(::testing::TempDir()) / ("loop_closing_test_" + std::to_string(getpid()));
  }

  /// A program of this workspace: its exit code; what it says is in log.txt.
  static int run(const std::string& program, const std::string& arguments) {
    const fs::path lib = fs::read_symlink("/proc/self/exe").parent_path().parent_path();
    const std::string command = (lib / program).string() + " " + arguments + " > " +
                                (folder() / "log.txt").string() + " 2>&1";
    return std::system(command.c_str());
  }

  static int runBag(const std::string& out, const std::string& more = "") {
    return run("vins_pipeline/run_bag", (folder() / "hall_rig.yaml").string() + " " +
                                            (folder() / "hall.bag").string() + " --out " +
                                            (folder() / out).string() + " " + more);
  }

  static std::vector<ToldLoop> loopsOf(const std::string& run) {
    std::vector<ToldLoop> loops;
    std::istringstream lines(textOf(folder() / run / "events.csv"));
    for (std::string line; std::getline(lines, line);) {
      if (line.find(",loop_found,") == std::string::npos) continue;
      ToldLoop loop;
      loop.stamp = std::stoll(line);
      std::istringstream figures(line.substr(line.rfind(',') + 1));
      for (std::string figure; figures >> figure;) {
        const std::size_t equals = figure.find('=');
        loop.figures[figure.substr(0, equals)] = std::stod(figure.substr(equals + 1));
      }
      loops.push_back(loop);
    }
    return loops;
  }

  /// Root mean square position error, after alignment [m].
  static double errorOf(const std::string& run, const std::string& name) {
    const std::string text = textOf(folder() / run / "evaluation.json");
    const std::size_t at =
        text.find("\"rmse\":", text.find("\"ate_m\"", text.find("\"name\": \"" + name)));
    return at == std::string::npos ? NAN : std::stod(text.substr(at + 7));
  }
};

TEST_F(LoopClosing, TheSecondRoundIsRecognisedAndBringsThePathNearerToTheTruth) {
  ASSERT_EQ(runBag("first"), 0) << textOf(folder() / "log.txt");
  const Trajectory truth = readTrajectoryFile((folder() / "hall_groundtruth.txt").string());
  const std::vector<ToldLoop> loops = loopsOf("first");
  // From 20 s on; the last ones come at a rest. One in two seconds is asked for, at least.
  EXPECT_GE(loops.size(), 8u);
  for (const ToldLoop& loop : loops) {
    const auto now = truth.interpolate(loop.stamp, 0.1);
    const auto then =
        truth.interpolate(loop.stamp - toNanoseconds(loop.figures.at("seconds_ago")), 0.1);
    ASSERT_TRUE(now && then);
    const double distance = (now->position - then->position).norm();
    // The hall is 14 m long, a wrong place is metres away; a right one is measured to some
    // centimetres.
    EXPECT_NEAR(loop.figures.at("distance_m"), distance, 0.3) << loop.stamp;
  }
  EXPECT_LE(errorOf("first", "loop_final"), errorOf("first", "vio_live"));

  // The same again, byte for byte.
  ASSERT_EQ(runBag("second"), 0);
  for (const char* file :
       {"vio_live.txt", "loop_live.txt", "loop_final.txt", "vins_result_loop.csv", "events.csv"}) {
    EXPECT_EQ(textOf(folder() / "first" / file), textOf(folder() / "second" / file)) << file;
    EXPECT_FALSE(textOf(folder() / "first" / file).empty()) << file;
  }
  ASSERT_EQ(runBag("alone", "--no-loop"), 0);
  // Loops that are refined in the window tell the odometry of its landmarks, and no more: neither
  // better nor worse than a centimetre on fifty metres.
  EXPECT_NEAR(errorOf("first", "vio_live"), errorOf("alone", "vio_live"), 0.01);
  EXPECT_FALSE(fs::exists(folder() / "alone/loop_live.txt"));
}

TEST_F(LoopClosing, ASecondRunFindsItselfInTheMapOfTheFirst) {
  const std::string map = (folder() / "maps/hall.map").string();
  ASSERT_EQ(runBag("mapped", "--duration 22 --save-map " + map), 0) << textOf(folder() / "log.txt");
  ASSERT_TRUE(fs::exists(map));
  // From another place of the same hall, in a process of its own.
  const std::string both = (folder() / "both.map").string();
  ASSERT_EQ(runBag("located", "--start 12 --load-map " + map + " --save-map " + both), 0)
      << textOf(folder() / "log.txt");
  EXPECT_NE(textOf(folder() / "log.txt").find("this run has joined it"), std::string::npos)
      << textOf(folder() / "log.txt");
  EXPECT_GT(fs::file_size(both), fs::file_size(map)) << "both runs are in it";
  // Where it begins the map is known already: from its first odometry on five seconds are allowed.
  const Trajectory located = readTrajectoryFile((folder() / "located/loop_final.txt").string());
  const std::vector<ToldLoop> loops = loopsOf("located");
  ASSERT_FALSE(loops.empty());
  EXPECT_LE(toSeconds(loops.front().stamp - located.poses().front().stamp), 5.0);

  // One path in the map's frame: the first run's, and what the second has flown after it.
  std::string joined = textOf(folder() / "mapped/loop_final.txt");
  const Stamp end =
      readTrajectoryFile((folder() / "mapped/loop_final.txt").string()).poses().back().stamp;
  for (const StampedPose& pose : located.poses()) {
    if (pose.stamp > end) joined += toTumLine(pose) + "\n";
  }
  std::ofstream(folder() / "joined.txt") << joined;
  fs::create_directories(folder() / "joined");
  ASSERT_EQ(
      run("vins_tests/evaluate_trajectory",
          (folder() / "hall_groundtruth.txt").string() + " " + (folder() / "joined.txt").string() +
              " --align posyaw --json " + (folder() / "joined/evaluation.json").string()),
      0)
      << textOf(folder() / "log.txt");
  EXPECT_LT(errorOf("joined", "joined"), 0.1) << "[m]";
}

TEST_F(LoopClosing, TheMapsPoseGoesOnOverAResetOfTheEstimator) {
  // Where nothing is recognized, after loops, the IMU is silent for longer than can be integrated
  // over.
  writeTwoCircles(folder() / "circles.txt");
  ASSERT_EQ(
      run("vins_tests/simulate_bag", "-o " + (folder() / "gap.bag").string() + " --trajectory " +
                                         (folder() / "circles.txt").string() +
                                         " --scene hall --rate 10 --imu-gap 35:0.7 --camera " +
                                         (folder() / "camera.yaml").string()),
      0);
  ASSERT_EQ(run("vins_pipeline/run_bag", (folder() / "hall_rig.yaml").string() + " " +
                                             (folder() / "gap.bag").string() + " --out " +
                                             (folder() / "gap").string()),
            0)
      << textOf(folder() / "log.txt");
  ASSERT_NE(textOf(folder() / "gap/events.csv").find(",reset,"), std::string::npos);
  const Trajectory vio = readTrajectoryFile((folder() / "gap/vio_live.txt").string());
  const Trajectory map = readTrajectoryFile((folder() / "gap/loop_live.txt").string());
  ASSERT_EQ(vio.poses().size(), map.poses().size());
  std::size_t after = 1;  // the first pose after the longest pause
  const auto pause = [&](std::size_t i) { return vio.poses()[i].stamp - vio.poses()[i - 1].stamp; };
  for (std::size_t i = 1; i < vio.poses().size(); ++i) after = pause(i) > pause(after) ? i : after;
  ASSERT_GT(toSeconds(pause(after)), 0.7) << "the reset's";
  const auto correction = [&](std::size_t i) {
    return map.poses()[i].T_wb * vio.poses()[i].T_wb.inverse();
  };
  const Pose before = correction(after - 1), begun = correction(after);
  RecordProperty("correction_mm", static_cast<int>(1e3 * before.position.norm()));
  EXPECT_GT(before.position.norm(), 0.003) << "loops have corrected something [m]";
  // No loop has joined the new sequence in its very first frame: the correction is the last one's.
  EXPECT_LT((begun.position - before.position).norm(), 0.1 * before.position.norm());
}

TEST_F(LoopClosing, MapsThatCannotBeReadAreTold) {
  EXPECT_NE(runBag("no_map", "--load-map /no/such.map"), 0);
  EXPECT_NE(textOf(folder() / "log.txt").find("/no/such.map: is no map file"), std::string::npos);
  std::ofstream(folder() / "foreign.map") << "no map";
  EXPECT_NE(runBag("no_map", "--load-map " + (folder() / "foreign.map").string()), 0);
  EXPECT_NE(textOf(folder() / "log.txt").find("is no map of this program"), std::string::npos);
  EXPECT_NE(runBag("no_map", "--no-loop --save-map " + (folder() / "a.map").string()), 0);
}

}  // namespace
}  // namespace vins::tests
