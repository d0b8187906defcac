#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vins_pipeline/run_results.h"

namespace vins::pipeline {

/// What to evaluate.
struct TrajectoryReport {
  std::string ground_truth;            ///< in any form that evaluate_trajectory reads
  std::vector<std::string> estimates;  ///< likewise; compared with one another
  std::string alignment = "posyaw";
  std::string html;  ///< page to write
  std::string json;  ///< figures to write
};

/// Throws InputError for an alignment that evaluate_trajectory does not have.
void requireAlignment(const std::string& name);

/// The trajectory file as it is to be compared with ground truth: a copy at the IMU's time in the
/// folder at_imu_time beside it, or the file itself where td is 0.
std::string atImuTime(const std::filesystem::path& file, const RunResults& results);

/// The program evaluate_trajectory of the package vins_tests: beside this program's own package, or
/// on PATH. Empty where it is not to be found.
std::string findEvaluation();

/// Runs a program with the console of this one. Its exit code; 128 + n where signal n ended it,
/// 127 where it could not be run.
int runProgram(const std::vector<std::string>& arguments);

/// Prints figures and writes the page. False, and told in one line, where evaluate_trajectory is
/// not installed. Throws InputError naming the page where it could not be made: evaluate_trajectory
/// has then told why, naming the file.
bool makeReport(const TrajectoryReport& report);

}  // namespace vins::pipeline
