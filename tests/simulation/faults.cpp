#include "simulation/faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

bool isInGap(const std::vector<TimeInterval>& gaps, double t_s) {
  return std::any_of(gaps.begin(), gaps.end(),
                     [&](const TimeInterval& gap) { return t_s > gap.begin_s && t_s < gap.end_s; });
}

/// Index of the first sample that arrives at or after `t_s`; the number of samples where none does.
std::size_t firstFrom(const std::vector<ArrivedSample>& samples, Stamp start, double t_s) {
  const auto found = std::find_if(samples.begin(), samples.end(), [&](const ArrivedSample& s) {
    return s.arrival - start >= toNanoseconds(t_s);
  });
  return static_cast<std::size_t>(found - samples.begin());
}

double parseNumber(const std::string& text) {
  std::size_t used = 0;
  try {
    const double value = std::stod(text, &used);
    if (used == text.size() && std::isfinite(value) && value >= 0.0) return value;
  } catch (const std::exception&) {
    // No number: what follows says it for every case.
  }
  return -1.0;
}

}  // namespace

Faults faultBagPreset() {
  Faults faults;
  faults.imu.gaps = {{12.0, 12.05}, {18.0, 18.2}};
  faults.imu.not_finite = {24.0};
  faults.imu.duplicates = {26.0};
  faults.imu.reversals = {28.0};
  faults.frames.dropped = {{32.0, 32.2}};
  faults.frames.blackouts = {{38.0, 39.0}};
  return faults;
}

std::vector<ArrivedSample> withFaults(const std::vector<ImuSample>& samples, Stamp start,
                                      const ImuFaults& faults) {
  std::vector<ArrivedSample> arrived;
  for (const ImuSample& sample : samples) {
    if (!isInGap(faults.gaps, toSeconds(sample.stamp - start))) {
      arrived.push_back({sample.stamp, sample});
    }
  }
  for (const double t_s : faults.not_finite) {
    const std::size_t i = firstFrom(arrived, start, t_s);
    if (i >= arrived.size()) continue;
    arrived[i].sample.acceleration.x() = std::numeric_limits<double>::quiet_NaN();
  }
  for (const double t_s : faults.reversals) {
    const std::size_t i = firstFrom(arrived, start, t_s);
    if (i + 1 < arrived.size()) std::swap(arrived[i].sample, arrived[i + 1].sample);
  }
  for (const double t_s : faults.duplicates) {
    const std::size_t i = firstFrom(arrived, start, t_s);
    if (i >= arrived.size()) continue;
    const ArrivedSample twin = arrived[i];
    arrived.insert(arrived.begin() + static_cast<std::ptrdiff_t>(i), twin);
  }
  return arrived;
}

bool contains(const std::vector<TimeInterval>& intervals, double t_s) {
  return std::any_of(intervals.begin(), intervals.end(), [&](const TimeInterval& interval) {
    return t_s >= interval.begin_s && t_s < interval.end_s;
  });
}

TimeInterval parseInterval(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  const double begin = parseNumber(text.substr(0, colon));
  const double duration = colon == std::string::npos ? -1.0 : parseNumber(text.substr(colon + 1));
  if (begin < 0.0 || duration <= 0.0) {
    throw InputError(option + ": found '" + text +
                     "'; allowed: START:DURATION in seconds, such as 12:0.5");
  }
  return {begin, begin + duration};
}

std::vector<TimeInterval> parseIntervals(const std::string& option,
                                         const std::vector<std::string>& texts) {
  std::vector<TimeInterval> intervals;
  for (const std::string& text : texts) intervals.push_back(parseInterval(option, text));
  return intervals;
}

}  // namespace vins::simulation
