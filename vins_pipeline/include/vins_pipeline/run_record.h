#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "vins_core/event.h"
#include "vins_core/time.h"

namespace vins::pipeline {

/// How long one piece of work took.
struct Duration {
  double wall = 0.0;  ///< [s]
  double cpu = 0.0;   ///< of all threads of the process [s]
};

/// Measures from its making on.
class StopWatch {
 public:
  StopWatch();
  Duration elapsed() const;

 private:
  std::chrono::steady_clock::time_point wall_;
  double cpu_;
};

/// A stage's work in a run.
struct StageSummary {
  std::size_t count = 0;
  double mean_ms = 0.0, median_ms = 0.0, p95_ms = 0.0, max_ms = 0.0;  ///< wall clock
  double cpu_seconds = 0.0;  ///< in all; 0 where only wall clock was measured
};

/// What a run took and what happened in it: for timing.json and the table at the end. Nothing of
/// the result depends on it.
class RunRecord {
 public:
  RunRecord();

  /// Stages keep the order in which they first came.
  void addDuration(const std::string& stage, const Duration& duration);
  /// What the stages took for one image, and tracker and estimator together (tracker+estimator)
  /// where both have worked.
  void addFrame(const std::vector<std::pair<std::string, Duration>>& durations);
  void addEvents(const std::vector<Event>& events);

  const std::vector<std::string>& stages() const { return stages_; }
  StageSummary summaryOf(const std::string& stage) const;
  const std::vector<Event>& events() const { return events_; }

  /// Since the record was made.
  Duration elapsed() const { return watch_.elapsed(); }

  /// timing.json: per stage count, mean_ms, median_ms, p95_ms, max_ms and cpu_seconds; cpu_seconds,
  /// wall_seconds, data_seconds, real_time_factor (data time over wall time) and peak_memory_mb.
  std::string timingJson(double data_seconds) const;

  /// events.csv: stamp [ns], severity, code, text, figures.
  std::string eventsCsv() const;

  /// A table of the stages, for people.
  std::string timingTable() const;

 private:
  StopWatch watch_;
  std::vector<std::string> stages_;
  std::map<std::string, std::vector<Duration>> durations_;
  std::vector<Event> events_;
};

/// The most memory that the process has had [MB, 1e6 bytes].
double peakMemoryMb();

}  // namespace vins::pipeline
