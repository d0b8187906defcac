// The tool, run as a user runs it.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "noisy_sphere.h"
#include "pose_graph/graph/six_dof_start.h"
#include "pose_graph/map/g2o_file.h"

namespace fs = std::filesystem;

namespace vins::pose_graph {
namespace {

struct Outcome {
  int exit_code = 0;
  std::string output;
};

class OptimizeG2o : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    G2oFile file;
    file.graph = testing::noisySphere(6, 12, 0.05, false, 1);
    startFromOdometry(&file.graph);
    writeG2oFile(in_, file);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome run(const std::string& arguments) const {
    const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "optimize_g2o";
    const std::string log = (folder_ / "log").string();
    const int status =
        std::system((tool.string() + " " + arguments + " > " + log + " 2>&1").c_str());
    std::ifstream in(log);
    return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(in), {})};
  }

  fs::path folder_ = fs::path(::testing::TempDir()) / "optimize_g2o_test";
  std::string in_ = (folder_ / "in.g2o").string();
  std::string out_ = (folder_ / "out.g2o").string();
};

double finalCost(const std::string& output) {
  const std::size_t arrow = output.rfind("-> ");
  return arrow == std::string::npos ? -1.0 : std::atof(output.c_str() + arrow + 3);
}

TEST_F(OptimizeG2o, AllMethodsAndStartsEndAtTheSameCost) {
  const double reference = finalCost(run(in_ + " " + out_).output);
  EXPECT_GT(reference, 0.0);
  for (const std::string method : {"gauss-newton", "levenberg-marquardt", "dogleg"}) {
    for (const std::string start : {"best", "file", "odometry", "spanning-tree", "chordal"}) {
      const Outcome outcome = run(in_ + " " + out_ + " --method " + method + " --start " + start);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
      EXPECT_NEAR(finalCost(outcome.output), reference, 1e-6 * reference) << method << " " << start;
    }
  }
  // What was written is the optimum: from there the cost is the same at the start.
  const Outcome again = run(out_ + " " + out_ + " --iterations 1");
  EXPECT_NEAR(finalCost(again.output), reference, 1e-9 * reference) << again.output;
}

TEST_F(OptimizeG2o, StartsFromWhatCostsLess) {
  const Outcome first = run(in_ + " " + out_);
  EXPECT_NE(first.output.find("starting from the chordal start"), std::string::npos)
      << "odometry has drifted: " << first.output;
  const Outcome again = run(out_ + " " + out_);
  EXPECT_NE(again.output.find("starting from the file's poses"), std::string::npos)
      << "nothing beats the optimum: " << again.output;
}

TEST_F(OptimizeG2o, DrawsAPicture) {
  const std::string picture = (folder_ / "picture.png").string();
  EXPECT_EQ(run(in_ + " " + out_ + " --kernel huber --picture " + picture).exit_code, 0);
  EXPECT_GT(fs::file_size(picture), 1000u);
  const Outcome outcome = run(in_ + " " + out_ + " --picture /no/such/folder/picture.png");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("/no/such/folder/picture.png: cannot be written"),
            std::string::npos);
}

TEST_F(OptimizeG2o, SaysThatItHasNotConverged) {
  const Outcome outcome = run(in_ + " " + out_ + " --start file --iterations 1");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.output.find("out of iterations"), std::string::npos) << outcome.output;
}

TEST_F(OptimizeG2o, TellsWhatIsWrongAndLeavesNothingBehind) {
  EXPECT_EQ(run("--help").exit_code, 0);
  EXPECT_EQ(run("").exit_code, 1);
  const auto expectFailure = [this](const std::string& arguments, const std::string& message) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_NE(outcome.output.find(message), std::string::npos) << outcome.output;
    EXPECT_FALSE(fs::exists(out_));
    EXPECT_FALSE(fs::exists(out_ + ".part"));
  };
  expectFailure("/no/such/file.g2o " + out_, "/no/such/file.g2o: cannot be opened");
  expectFailure(in_ + " " + out_ + " --method newton", "found 'newton'; allowed: dogleg");
  expectFailure(in_ + " " + out_ + " --kernel tukey", "--kernel: found 'tukey'");
  expectFailure(in_ + " " + out_ + " --kernel huber --kernel-width 0", "width is 0; allowed");
  expectFailure(in_ + " " + out_ + " --iterations -3", "max_iterations is -3");
  std::ofstream(in_, std::ios::app) << "EDGE_SE3:QUAT 0 1 2\n";
  expectFailure(in_ + " " + out_, "in.g2o:");
}

}  // namespace
}  // namespace vins::pose_graph
