// What an hour of keyframes costs: memory, index, query, optimization and map file over time, of a
// walk round and round a simulated town, or of standing still in it.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>

#include <boost/program_options.hpp>

#include "camera_model/testing/example_cameras.h"
#include "pose_graph/pose_graph.h"
#include "town_walk.h"
#include "vins_core/option_check.h"
#include "vins_core/progress_bar.h"
#include "vins_core/resident_memory.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"
#include "vins_core/wall_clock.h"

namespace po = boost::program_options;

namespace {

/// Sums since the last row.
struct Costs {
  int keyframes = 0, optimizations = 0;
  double query = 0.0, verify = 0.0, add = 0.0, optimize = 0.0, worst_optimize = 0.0;  // [s]

  void take(const vins::pose_graph::PoseGraphResult& result, double seconds) {
    ++keyframes;
    query += result.search.query_seconds;
    verify += result.search.verify_seconds;
    add += seconds - result.optimize_seconds;
    if (result.optimize_seconds <= 0.0) return;
    ++optimizations;
    optimize += result.optimize_seconds;
    worst_optimize = std::max(worst_optimize, result.optimize_seconds);
  }
};

struct Study {
  double seconds = 3600.0, row = 60.0;
  std::string csv, map_file;
  vins::pose_graph::PoseGraphOptions options;
  vins::pose_graph::TownWalkOptions walk;
};

/// Root mean square distance of the map's keyframes from where they truly were [m].
double errorOf(vins::pose_graph::PoseGraph* graph,
               const std::map<std::int64_t, Eigen::Vector3d>& truth) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const vins::pose_graph::SequencePath& path : graph->paths()) {
    for (const vins::pose_graph::KeyframeVertex& keyframe : path.keyframes) {
      sum += (keyframe.T_mb.position - truth.at(keyframe.id)).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
}

std::string rowOf(double time, const Study& study, const Costs& costs,
                  vins::pose_graph::PoseGraph* graph, double error) {
  const vins::pose_graph::PoseGraphStatistics statistics = graph->statistics();
  vins::WallClock clock;
  graph->save(study.map_file);
  const double save = clock.lap();
  const double file = 1e-6 * static_cast<double>(std::filesystem::file_size(study.map_file));
  char row[512];
  std::snprintf(
      row, sizeof(row), "%.0f,%.1f,%zu,%zu,%zu,%.1f,%.1f,%.3f,%.3f,%.3f,%.3f,%.3f,%.1f,%.3f,%.3f\n",
      time, study.walk.speed * time, statistics.keyframes, statistics.loops, statistics.removed,
      vins::residentMegabytes(), 1e-6 * static_cast<double>(statistics.memory),
      1e3 * costs.query / costs.keyframes, 1e3 * costs.verify / costs.keyframes,
      1e3 * costs.add / costs.keyframes, 1e3 * costs.optimize / std::max(1, costs.optimizations),
      1e3 * costs.worst_optimize, file, save, error);
  return row;
}

void walkAndMeasure(const Study& study) {
  vins::pose_graph::TownWalk walk(study.walk);
  vins::pose_graph::PoseGraph graph(
      study.options, vins::camera_model::testing::exampleCameras().front(), walk.places());
  const auto count = static_cast<std::size_t>(study.seconds / study.walk.period);
  const auto per_row = static_cast<std::size_t>(study.row / study.walk.period);
  auto bar = vins::ProgressBar::onStandardError("keyframes", count);
  std::string table =
      "time_s,distance_m,keyframes,loops,removed,resident_mb,graph_mb,query_ms,verify_ms,add_ms,"
      "optimize_ms,worst_optimize_ms,file_mb,save_s,position_error_m\n";
  Costs costs;
  std::map<std::int64_t, Eigen::Vector3d> truth;
  for (std::size_t i = 1; i <= count; ++i) {
    vins::pose_graph::TownKeyframe next = walk.next();
    truth[next.keyframe.id] = next.truth.position;
    vins::WallClock clock;
    const vins::pose_graph::PoseGraphResult result =
        graph.addDescribed(next.keyframe, std::move(next.described));
    costs.take(result, clock.lap());
    bar.update(i, "");
    if (i % per_row != 0) continue;
    const double time = study.walk.period * static_cast<double>(i);
    table += rowOf(time, study, costs, &graph, errorOf(&graph, truth));
    vins::writeTextFile(study.csv, table);
    costs = {};
  }
  bar.finish("");
  std::cout << table;
}

po::options_description describeOptions() {
  po::options_description options("Options");
  auto add = options.add_options();
  add("csv", po::value<std::string>()->required(), "table to write; a row for each minute");
  add("map", po::value<std::string>()->required(), "where the map is saved, again and again");
  add("seconds", po::value<double>()->default_value(3600.0), "of the walk");
  add("row", po::value<double>()->default_value(60.0), "seconds of the walk in a row of the table");
  add("speed", po::value<double>()->default_value(1.39), "of the walk [m/s]; 0: stands still");
  add("sway", po::value<double>()->default_value(0.6), "to both sides [m]");
  add("lap", po::value<double>()->default_value(1000.0), "length of the round road [m]");
  add("loop-interval", po::value<double>()->default_value(2.0),
      "after a loop nothing is verified for so long [s]: each loop is optimized at once");
  add("max-keyframes", po::value<int>()->default_value(2000), "that the map may have");
  return options;
}

Study readStudy(const po::variables_map& values) {
  Study study;
  study.seconds = values["seconds"].as<double>();
  study.row = values["row"].as<double>();
  study.csv = values["csv"].as<std::string>();
  study.map_file = values["map"].as<std::string>();
  study.walk.lap = values["lap"].as<double>();
  study.walk.speed = values["speed"].as<double>();
  study.walk.sway = values["sway"].as<double>();
  study.options.threaded = false;
  study.options.loops.min_interval = values["loop-interval"].as<double>();
  study.options.thinning.max_keyframes = values["max-keyframes"].as<int>();
  vins::requireWithin("map_growth", "row", study.row, {study.walk.period, 1e5});
  vins::requireWithin("map_growth", "seconds", study.seconds, {study.row, 1e5});
  vins::requireWithin("map_growth", "lap", study.walk.lap, {50.0, 1e4});
  vins::requireWithin("map_growth", "speed", study.walk.speed, {0.0, 100.0});
  vins::requireWithin("map_growth", "sway", study.walk.sway, {0.0, 10.0});
  return study;
}

vins::ToolExit run(const po::variables_map& values) {
  walkAndMeasure(readStudy(values));
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{"map_growth",
                                   "What an hour of simulated keyframes costs.\n"
                                   "Usage: map_growth --csv TABLE.csv --map FILE [options]\n",
                                   describeOptions()};
  return vins::runTool(argc, argv, tool, run);
}
