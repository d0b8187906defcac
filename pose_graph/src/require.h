#pragma once

#include <cmath>
#include <sstream>
#include <string>

#include "vins_core/input_error.h"
#include "vins_core/parameters.h"

namespace vins {

/// Throws InputError naming owner, option, value and what is allowed, where it is out of range.
inline void requireOption(const char* owner, const char* option, double value,
                          const Range& allowed) {
  if (std::isfinite(value) && value >= allowed.min && value <= allowed.max) return;
  std::ostringstream message;
  message << owner << ": " << option << " is " << value << "; allowed: " << allowed.min << " to "
          << allowed.max;
  throw InputError(message.str());
}

}  // namespace vins
