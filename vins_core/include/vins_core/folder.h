#pragma once

#include <string>

namespace vins {

/// Makes a folder and those above it, where they are missing. Throws InputError naming it, with the
/// reason.
void makeFolder(const std::string& path);

/// Makes the folder that a file shall lie in. Throws like makeFolder().
void makeFolderOf(const std::string& file);

/// A path as a file gives it: relative ones are seen from that file's folder, "~/" is the user's
/// home. "" stays "".
std::string pathSeenFrom(const std::string& file, const std::string& path);

}  // namespace vins
