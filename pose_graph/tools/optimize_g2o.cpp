// Optimizes a pose graph in g2o's format and shows how the cost falls.

#include <chrono>
#include <iomanip>
#include <iostream>
#include <map>
#include <string>
#include <utility>

#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "graph_picture.h"
#include "pose_graph/graph/six_dof.h"
#include "pose_graph/graph/six_dof_start.h"
#include "pose_graph/map/g2o_file.h"
#include "vins_core/input_error.h"
#include "vins_core/run_tool.h"

namespace po = boost::program_options;

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The value that `options` has for a name given on the command line.
template <typename T>
T choose(const char* option, const std::map<std::string, T>& choices, const std::string& found) {
  const auto choice = choices.find(found);
  if (choice != choices.end()) return choice->second;
  std::string allowed;
  for (const auto& item : choices) allowed += (allowed.empty() ? "" : ", ") + item.first;
  throw vins::InputError("--" + std::string(option) + ": found '" + found +
                         "'; allowed: " + allowed);
}

enum class Start { kBest, kFile, kOdometry, kSpanningTree, kChordal };

const std::map<std::string, Start> kStarts = {{"best", Start::kBest},
                                              {"file", Start::kFile},
                                              {"odometry", Start::kOdometry},
                                              {"spanning-tree", Start::kSpanningTree},
                                              {"chordal", Start::kChordal}};
const std::map<std::string, vins::pose_graph::MinimizerMethod> kMethods = {
    {"gauss-newton", vins::pose_graph::MinimizerMethod::kGaussNewton},
    {"levenberg-marquardt", vins::pose_graph::MinimizerMethod::kLevenbergMarquardt},
    {"dogleg", vins::pose_graph::MinimizerMethod::kDogleg}};
const std::map<std::string, vins::pose_graph::KernelType> kKernels = {
    {"none", vins::pose_graph::KernelType::kNone},
    {"huber", vins::pose_graph::KernelType::kHuber},
    {"cauchy", vins::pose_graph::KernelType::kCauchy},
    {"geman-mcclure", vins::pose_graph::KernelType::kGemanMcClure}};

po::options_description describeOptions() {
  const vins::pose_graph::SixDofOptions defaults;
  po::options_description options;
  auto add = options.add_options();
  add("in", po::value<std::string>()->required(), "graph to read");
  add("out", po::value<std::string>()->required(), "graph to write");
  add("method", po::value<std::string>()->default_value("levenberg-marquardt"),
      "gauss-newton, levenberg-marquardt or dogleg");
  add("kernel", po::value<std::string>()->default_value("none"),
      "of all edges: none, huber, cauchy or geman-mcclure");
  add("kernel-width", po::value<double>()->default_value(defaults.kernel.width),
      "whitened error from which on the kernel takes effect");
  add("iterations", po::value<int>()->default_value(defaults.minimizer.max_iterations), "at most");
  add("start", po::value<std::string>()->default_value("best"),
      "poses to start from: file, odometry (edges between neighbours), spanning-tree, chordal (a "
      "linear estimate of the rotations), or best (file or chordal, whichever costs less)");
  add("picture", po::value<std::string>(),
      "image file for a drawing: the file's poses and the "
      "result");
  return options;
}

void printIteration(const vins::pose_graph::IterationReport& report) {
  std::cout << std::setw(9) << report.iteration << std::setw(20) << std::setprecision(10)
            << report.cost << std::setw(14) << std::setprecision(4) << report.step_length
            << std::setw(14) << report.restraint << (report.accepted ? "" : "  rejected") << "\n";
}

vins::pose_graph::SixDofOptions readOptions(const po::variables_map& values) {
  vins::pose_graph::SixDofOptions options;
  options.kernel.type = choose("kernel", kKernels, values["kernel"].as<std::string>());
  options.kernel.width = values["kernel-width"].as<double>();
  options.minimizer.method = choose("method", kMethods, values["method"].as<std::string>());
  options.minimizer.max_iterations = values["iterations"].as<int>();
  options.minimizer.on_iteration = printIteration;
  options.validate();
  return options;
}

double costOf(vins::pose_graph::RelativePoseGraph graph, vins::pose_graph::SixDofOptions options) {
  options.minimizer.max_iterations = 0;
  options.minimizer.on_iteration = nullptr;
  return vins::pose_graph::optimizeSixDof(&graph, options).initial_cost;
}

/// Poses far from any minimum, as files of odometry have them, may lead into a wrong valley.
void placeAtBest(const vins::pose_graph::SixDofOptions& options,
                 vins::pose_graph::RelativePoseGraph* graph) {
  vins::pose_graph::RelativePoseGraph chordal = *graph;
  if (!vins::pose_graph::startFromChordalRotations(&chordal)) return;
  const double of_file = costOf(*graph, options), of_chordal = costOf(chordal, options);
  const bool is_better = !(of_file <= of_chordal);
  std::cout << std::setprecision(10) << "cost of the file's poses " << of_file
            << ", of the chordal start " << of_chordal << ": starting from the "
            << (is_better ? "chordal start" : "file's poses") << "\n";
  if (is_better) *graph = std::move(chordal);
}

void placeAtStart(Start start, const vins::pose_graph::SixDofOptions& options,
                  vins::pose_graph::RelativePoseGraph* graph) {
  const auto begin = Clock::now();
  if (start == Start::kBest) placeAtBest(options, graph);
  if (start == Start::kOdometry) vins::pose_graph::startFromOdometry(graph);
  if (start == Start::kSpanningTree) vins::pose_graph::startFromSpanningTree(graph);
  if (start == Start::kChordal && !vins::pose_graph::startFromChordalRotations(graph)) {
    std::cerr << "the chordal start has no solution; starting from the spanning tree\n";
  }
  if (start != Start::kFile) std::cout << "start: " << secondsSince(begin) << " s\n";
}

const char* toString(vins::pose_graph::MinimizerStatus status) {
  if (status == vins::pose_graph::MinimizerStatus::kConverged) return "converged";
  if (status == vins::pose_graph::MinimizerStatus::kFailed) return "failed: no finite solution";
  return "out of iterations";
}

void writePicture(const std::string& path, const vins::pose_graph::RelativePoseGraph& before,
                  const vins::pose_graph::RelativePoseGraph& after) {
  bool written = false;
  try {
    written = cv::imwrite(path, vins::pose_graph::drawGraphs(before, after));
  } catch (const cv::Exception&) {
    // An extension that OpenCV does not know: the same message as for a folder that is not there.
  }
  if (!written) throw vins::InputError(path + ": cannot be written as an image");
}

/// Falls short where the minimization came to no end.
vins::ToolExit optimize(const po::variables_map& values) {
  const vins::pose_graph::SixDofOptions options = readOptions(values);
  const Start start = choose("start", kStarts, values["start"].as<std::string>());
  vins::pose_graph::G2oFile file = vins::pose_graph::readG2oFile(values["in"].as<std::string>());
  for (const std::string& warning : file.warnings) std::cerr << warning << "\n";
  std::cout << file.graph.poses.size() << " poses in " << (file.graph.planar ? 2 : 3) << "-D, "
            << file.graph.edges.size() << " edges\n";
  const vins::pose_graph::RelativePoseGraph before = file.graph;
  placeAtStart(start, options, &file.graph);
  std::cout << "iteration                cost   step length     restraint\n";
  const auto begin = Clock::now();
  const vins::pose_graph::MinimizerSummary summary =
      vins::pose_graph::optimizeSixDof(&file.graph, options);
  const double seconds = secondsSince(begin);
  std::cout << toString(summary.status) << " after " << summary.iterations << " iterations and "
            << std::setprecision(3) << seconds << " s: cost " << std::setprecision(10)
            << summary.initial_cost << " -> " << summary.final_cost << "\n";
  if (summary.status == vins::pose_graph::MinimizerStatus::kFailed)
    return vins::ToolExit::kFellShort;
  vins::pose_graph::writeG2oFile(values["out"].as<std::string>(), file);
  if (values.count("picture") > 0) {
    writePicture(values["picture"].as<std::string>(), before, file.graph);
  }
  return summary.status == vins::pose_graph::MinimizerStatus::kConverged
             ? vins::ToolExit::kDone
             : vins::ToolExit::kFellShort;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "optimize_g2o",
      "Optimizes a pose graph in g2o's format, of SE(2) or SE(3). Cost: half the sum of\n"
      "the squared errors, weighted by the information matrices. Restraint: damping of\n"
      "Levenberg-Marquardt, radius of dogleg.\n"
      "Usage: optimize_g2o IN.g2o OUT.g2o [OPTIONS]\n"
      "Example: optimize_g2o sphere.g2o best.g2o --picture sphere.png\n"
      "Exit code: 0 converged, 2 not (OUT is written unless it failed), 1 bad input.\n",
      describeOptions(),
      {{"in", 1}, {"out", 1}}};
  return vins::runTool(argc, argv, tool, optimize);
}
