#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "vins_core/time.h"

namespace vins {

/// How much a user should care about an event.
enum class Severity { kInfo, kWarning, kError };

/// Something a user should hear from a library (which itself never logs): "initialised",
/// "imu_gap", "tracking_lost". Nodes log it and publish it as diagnostics.
struct Event {
  Stamp stamp = 0;  ///< time of the data it is about [ns]
  Severity severity = Severity::kInfo;
  std::string code;                                     ///< stable, for programs: "imu_gap"
  std::string text;                                     ///< for people: what happened, what to do
  std::vector<std::pair<std::string, double>> figures;  ///< named figures, unit in the name
};

/// "info", "warning" or "error".
const char* toString(Severity severity);

/// One line: seconds, severity, code, text, figures.
std::ostream& operator<<(std::ostream& out, const Event& event);

}  // namespace vins
