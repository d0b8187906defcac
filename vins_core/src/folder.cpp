#include "vins_core/folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "vins_core/input_error.h"

namespace fs = std::filesystem;

namespace vins {

void makeFolder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  // Of "folder/" it says that nothing was made, which is no error.
  if (fs::is_directory(path)) return;
  throw InputError(path + ": cannot be made: " +
                   (error ? error.message() : std::string("a file of that name is there")));
}

void makeFolderOf(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty()) makeFolder(folder.string());
}

std::string pathSeenFrom(const std::string& file, const std::string& path) {
  if (path.empty()) return "";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && path.rfind("~/", 0) == 0) return home + path.substr(1);
  return (std::filesystem::path(file).parent_path() / path).string();
}

}  // namespace vins
