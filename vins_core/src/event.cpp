#include "vins_core/event.h"

#include <iomanip>
#include <sstream>

namespace vins {

const char* toString(Severity severity) {
  switch (severity) {
    case Severity::kInfo:
      return "info";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "error";
  }
  return "unknown";
}

std::ostream& operator<<(std::ostream& out, const Event& event) {
  std::ostringstream line;
  line << std::fixed << std::setprecision(3) << toSeconds(event.stamp) << std::defaultfloat << " "
       << toString(event.severity) << " " << event.code << ": " << event.text;
  const char* separator = " (";
  for (const auto& [name, value] : event.figures) {
    line << separator << name << " = " << value;
    separator = ", ";
  }
  if (!event.figures.empty()) line << ")";
  return out << line.str();
}

}  // namespace vins
