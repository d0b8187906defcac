#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace vins::testing {

/// Path in the folder of real recordings: $VINS_SHARED_DATA, or ../../shared/data seen from the
/// package's folder, where tests run. Tests that need what is not there are skipped.
inline std::string sharedData(const std::string& path) {
  const char* folder = std::getenv("VINS_SHARED_DATA");
  return (std::filesystem::path(folder != nullptr ? folder : "../../shared/data") / path).string();
}

}  // namespace vins::testing

/// Skips the running test, in one line, where `path` is not there.
#define VINS_SKIP_WITHOUT(path)       \
  if (!std::filesystem::exists(path)) \
  GTEST_SKIP() << "needs " << (path) << " (set VINS_SHARED_DATA to the folder of recordings)"
