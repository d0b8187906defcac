#pragma once

#include <string>
#include <vector>

#include "simulation/image_options.h"
#include "vins_core/imu.h"

namespace vins::simulation {

/// What goes wrong with a recording's IMU samples. Times are seconds since the recording's start.
struct ImuFaults {
  std::vector<TimeInterval> gaps;  ///< no sample strictly between; those at both ends arrive
  std::vector<double> not_finite;  ///< the first sample from here on has a NaN acceleration
  std::vector<double> duplicates;  ///< the first sample from here on arrives twice
  std::vector<double> reversals;   ///< the first sample from here on arrives after the next one
};

/// What goes wrong with its images.
struct FrameFaults {
  std::vector<TimeInterval> dropped;    ///< images from begin until just before end are not there
  std::vector<TimeInterval> blackouts;  ///< and these are black
};

struct Faults {
  ImuFaults imu;
  FrameFaults frames;
};

/// The faults of the "fault bag":
///
/// | at [s]       | what                                          |
/// |--------------|-----------------------------------------------|
/// | 12 to 12.05  | IMU gap of 50 ms                              |
/// | 18 to 18.2   | IMU gap of 200 ms                             |
/// | 24           | IMU sample with NaN                           |
/// | 26           | IMU sample twice                              |
/// | 28           | two IMU samples in reversed order             |
/// | 32 to 32.2   | images dropped (four at 20 Hz)                |
/// | 38 to 39     | blackout                                      |
Faults faultBagPreset();

/// The shortest recording that faultBagPreset() fits into, with time to recover [s].
constexpr double kFaultBagDuration = 45.0;

/// A sample, and when it arrives, which is the order in which a bag has it.
struct ArrivedSample {
  Stamp arrival = 0;  ///< [ns]
  ImuSample sample;
};

/// The samples with the faults applied; arrivals do not fall. `start` is the recording's start.
std::vector<ArrivedSample> withFaults(const std::vector<ImuSample>& samples, Stamp start,
                                      const ImuFaults& faults);

/// One of the intervals has `t_s` in [begin, end).
bool contains(const std::vector<TimeInterval>& intervals, double t_s);

/// Interval of "START:DURATION" [s]. Throws InputError naming `option` where it is none.
TimeInterval parseInterval(const std::string& option, const std::string& text);

/// The same for each of the texts.
std::vector<TimeInterval> parseIntervals(const std::string& option,
                                         const std::vector<std::string>& texts);

}  // namespace vins::simulation
