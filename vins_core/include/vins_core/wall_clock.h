#pragma once

#include <chrono>

namespace vins {

/// Wall clock time that pieces of work take, for statistics: nothing that is computed may depend on
/// it.
class WallClock {
 public:
  /// Since the last call, or since it was made [s].
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double passed = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return passed;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace vins
