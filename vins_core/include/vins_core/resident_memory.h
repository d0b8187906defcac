#pragma once

#include <fstream>

#include <unistd.h>

namespace vins {

/// Memory of this process that is in RAM now [MB = 10^6 bytes], for statistics; 0 where the system
/// does not tell (/proc/self/statm).
inline double residentMegabytes() {
  std::ifstream in("/proc/self/statm");
  double pages = 0.0, resident = 0.0;
  if (!(in >> pages >> resident)) return 0.0;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace vins
