#pragma once

#include <string>

namespace vins {

/// Writes text aside and renames it to `path`, so that no half-written file is left behind. Throws
/// InputError naming the file where it cannot be written.
void writeTextFile(const std::string& path, const std::string& text);

}  // namespace vins
