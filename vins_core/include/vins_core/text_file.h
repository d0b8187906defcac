#pragma once

#include <string>

namespace vins {

/// Writes text aside and renames it to `path`, so that no half-written file is left behind; makes
/// the folder where it is missing. Throws InputError naming the file, and why, where it cannot be
/// written.
void writeTextFile(const std::string& path, const std::string& text);

}  // namespace vins
