#pragma once

#include <string>

#include "vins_core/parameters.h"

namespace vins {

/// Throws InputError "OWNER: KEY is VALUE; allowed: ALLOWED".
[[noreturn]] void refuseOption(const std::string& owner, const std::string& key, double value,
                               const std::string& allowed);

/// Refuses a value that is not within `allowed` or not finite.
void requireWithin(const std::string& owner, const std::string& key, double value,
                   const Range& allowed);

/// Refuses a value that is not above zero or not finite.
void requirePositive(const std::string& owner, const std::string& key, double value);

}  // namespace vins
