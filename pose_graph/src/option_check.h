#pragma once

#include "vins_core/parameters.h"

namespace vins {

/// Throws InputError "OWNER: KEY is VALUE; allowed: MIN to MAX" where `value` is not within
/// `allowed` or not finite.
void requireWithin(const char* owner, const char* key, double value, const Range& allowed);

}  // namespace vins
