#include "option_check.h"

#include <cmath>
#include <sstream>

#include "vins_core/input_error.h"

namespace vins {

void requireWithin(const char* owner, const char* key, double value, const Range& allowed) {
  if (std::isfinite(value) && value >= allowed.min && value <= allowed.max) return;
  std::ostringstream message;
  message << owner << ": " << key << " is " << value << "; allowed: " << allowed.min << " to "
          << allowed.max;
  throw InputError(message.str());
}

}  // namespace vins
