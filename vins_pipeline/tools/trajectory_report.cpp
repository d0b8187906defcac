#include "trajectory_report.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vins_core/folder.h"
#include "vins_core/input_error.h"
#include "vins_core/text_file.h"
#include "vins_core/trajectory_file.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

constexpr char kProgram[] = "evaluate_trajectory";

bool isProgram(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

void requireAlignment(const std::string& name) {
  for (const char* known : {"none", "posyaw", "se3", "sim3"}) {
    if (name == known) return;
  }
  throw InputError("--align: found '" + name + "'; allowed: none, posyaw, se3, sim3");
}

std::string atImuTime(const fs::path& file, const RunResults& results) {
  const auto shifted = results.atImuTime(readTrajectoryFile(file.string()));
  if (!shifted) return file.string();
  const fs::path folder = file.parent_path() / "at_imu_time";
  makeFolder(folder.string());
  std::string text;
  for (const StampedPose& pose : shifted->poses()) text += toTumLine(pose) + "\n";
  writeTextFile((folder / file.filename()).string(), text);
  return (folder / file.filename()).string();
}

std::string findEvaluation() {
  // .../lib/vins_pipeline/run_bag has .../lib/vins_tests beside its folder.
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> folders = {self.parent_path().parent_path() / "vins_tests",
                                   self.parent_path()};
  std::istringstream path(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');) folders.emplace_back(folder);
  for (const fs::path& folder : folders) {
    if (isProgram(folder / kProgram)) return (folder / kProgram).string();
  }
  return "";
}

int runProgram(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts = arguments;
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  std::cout.flush();
  pid_t process = 0;
  if (posix_spawnp(&process, pointers[0], nullptr, nullptr, pointers.data(), environ) != 0) {
    return 127;
  }
  int status = 0;
  if (waitpid(process, &status, 0) < 0) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool makeReport(const TrajectoryReport& report) {
  const std::string program = findEvaluation();
  if (program.empty()) {
    std::cerr << "no report: evaluate_trajectory of the package vins_tests is not there\n";
    return false;
  }
  std::vector<std::string> arguments = {program, report.ground_truth};
  arguments.insert(arguments.end(), report.estimates.begin(), report.estimates.end());
  arguments.insert(arguments.end(),
                   {"--align", report.alignment, "--html", report.html, "--json", report.json});
  const int exit_code = runProgram(arguments);
  if (exit_code == 0) return true;
  throw InputError(report.html + ": not made, the other files are whole; " + program +
                   " has ended with code " + std::to_string(exit_code));
}

}  // namespace vins::pipeline
