#pragma once

#include <cmath>
#include <cstdint>

namespace vins {

/// Time stamps are nanoseconds since the sensor clock's epoch; durations are seconds as double.
using Stamp = std::int64_t;

/// Duration in seconds of a difference of two stamps. Exact below about 100 days.
inline double toSeconds(Stamp nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }

/// Nearest whole number of nanoseconds to a duration in seconds.
inline Stamp toNanoseconds(double seconds) {
  return static_cast<Stamp>(std::llround(seconds * 1e9));
}

}  // namespace vins
