#include "vins_core/option_check.h"

#include <cmath>
#include <sstream>

#include "vins_core/input_error.h"

namespace vins {

void refuseOption(const std::string& owner, const std::string& key, double value,
                  const std::string& allowed) {
  std::ostringstream message;
  message << owner << ": " << key << " is " << value << "; allowed: " << allowed;
  throw InputError(message.str());
}

void requireWithin(const std::string& owner, const std::string& key, double value,
                   const Range& allowed) {
  if (std::isfinite(value) && value >= allowed.min && value <= allowed.max) return;
  std::ostringstream range;
  range << allowed.min << " to " << allowed.max;
  refuseOption(owner, key, value, range.str());
}

void requirePositive(const std::string& owner, const std::string& key, double value) {
  if (!(std::isfinite(value) && value > 0.0)) refuseOption(owner, key, value, "a positive number");
}

}  // namespace vins
