#include "vins_pipeline/run_record.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <numeric>
#include <sstream>

#include <sys/resource.h>

namespace vins::pipeline {
namespace {

double cpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The value below which a share of the sorted values lies (nearest rank).
double quantile(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto index = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  return sorted[std::min(index, sorted.size() - 1)];
}

/// A text for a csv field.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

StopWatch::StopWatch() : wall_(std::chrono::steady_clock::now()), cpu_(cpuSeconds()) {}

Duration StopWatch::elapsed() const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_;
  return {wall.count(), cpuSeconds() - cpu_};
}

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1.024e-3 * static_cast<double>(usage.ru_maxrss);  // of kibibytes
}

RunRecord::RunRecord() = default;

void RunRecord::addDuration(const std::string& stage, const Duration& duration) {
  std::vector<Duration>& durations = durations_[stage];
  if (durations.empty()) stages_.push_back(stage);
  durations.push_back(duration);
}

void RunRecord::addFrame(const std::vector<std::pair<std::string, Duration>>& durations) {
  Duration frame;
  int stages = 0;
  for (const auto& [stage, duration] : durations) {
    addDuration(stage, duration);
    if (stage != "tracker" && stage != "estimator") continue;
    frame.wall += duration.wall;
    frame.cpu += duration.cpu;
    ++stages;
  }
  if (stages > 1) addDuration("tracker+estimator", frame);
}

void RunRecord::addEvents(const std::vector<Event>& events) {
  events_.insert(events_.end(), events.begin(), events.end());
}

StageSummary RunRecord::summaryOf(const std::string& stage) const {
  StageSummary summary;
  const auto found = durations_.find(stage);
  if (found == durations_.end()) return summary;
  std::vector<double> walls;
  for (const Duration& duration : found->second) {
    walls.push_back(1e3 * duration.wall);
    summary.cpu_seconds += duration.cpu;
  }
  std::sort(walls.begin(), walls.end());
  summary.count = walls.size();
  summary.mean_ms =
      std::accumulate(walls.begin(), walls.end(), 0.0) / static_cast<double>(walls.size());
  summary.median_ms = quantile(walls, 0.5);
  summary.p95_ms = quantile(walls, 0.95);
  summary.max_ms = walls.back();
  return summary;
}

std::string RunRecord::timingJson(double data_seconds) const {
  const Duration total = elapsed();
  std::ostringstream out;
  out << std::setprecision(6) << "{\n  \"stages\": {";
  const char* separator = "\n";
  for (const std::string& stage : stages_) {
    const StageSummary s = summaryOf(stage);
    out << separator << "    \"" << stage << "\": {\"count\": " << s.count
        << ", \"mean_ms\": " << s.mean_ms << ", \"median_ms\": " << s.median_ms
        << ", \"p95_ms\": " << s.p95_ms << ", \"max_ms\": " << s.max_ms
        << ", \"cpu_seconds\": " << s.cpu_seconds << "}";
    separator = ",\n";
  }
  out << "\n  },\n  \"cpu_seconds\": " << total.cpu << ",\n  \"wall_seconds\": " << total.wall
      << ",\n  \"data_seconds\": " << data_seconds
      << ",\n  \"real_time_factor\": " << data_seconds / std::max(total.wall, 1e-9)
      << ",\n  \"peak_memory_mb\": " << peakMemoryMb() << "\n}\n";
  return out.str();
}

std::string RunRecord::eventsCsv() const {
  std::ostringstream out;
  out << "#stamp [ns],severity,code,text,figures\n" << std::setprecision(9);
  for (const Event& event : events_) {
    out << event.stamp << "," << toString(event.severity) << "," << event.code << ","
        << quoted(event.text) << ",";
    const char* separator = "";
    for (const auto& [name, value] : event.figures) {
      out << separator << name << "=" << value;
      separator = " ";
    }
    out << "\n";
  }
  return out.str();
}

std::string RunRecord::timingTable() const {
  std::size_t width = 5;
  for (const std::string& stage : stages_) width = std::max(width, stage.size());
  std::ostringstream out;
  out << std::left << std::setw(static_cast<int>(width)) << "stage" << std::right
      << "    count   mean ms  median ms   p95 ms   max ms    CPU s\n"
      << std::fixed;
  for (const std::string& stage : stages_) {
    const StageSummary s = summaryOf(stage);
    out << std::left << std::setw(static_cast<int>(width)) << stage << std::right << std::setw(9)
        << s.count << std::setprecision(2) << std::setw(10) << s.mean_ms << std::setw(11)
        << s.median_ms << std::setw(9) << s.p95_ms << std::setw(9) << s.max_ms << std::setw(9);
    if (s.cpu_seconds > 0.0) {
      out << s.cpu_seconds << "\n";
    } else {
      out << "-"
          << "\n";
    }
  }
  return out.str();
}

}  // namespace vins::pipeline
