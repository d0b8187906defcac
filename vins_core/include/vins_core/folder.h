#pragma once

#include <string>

namespace vins {

/// Makes a folder and those above it, where they are missing. Throws InputError naming it, with the
/// reason.
void makeFolder(const std::string& path);

/// Makes the folder that a file shall lie in. Throws like makeFolder().
void makeFolderOf(const std::string& file);

}  // namespace vins
