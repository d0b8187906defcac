#include "vins_core/text_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "vins_core/folder.h"
#include "vins_core/input_error.h"

namespace vins {

void writeTextFile(const std::string& path, const std::string& text) {
  makeFolderOf(path);
  const std::string aside = path + ".part";
  errno = 0;
  std::ofstream out(aside, std::ios::binary);
  out << text << std::flush;
  out.close();
  if (out && std::rename(aside.c_str(), path.c_str()) == 0) return;
  const std::string why = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  std::remove(aside.c_str());
  throw InputError(path + ": cannot be written" + why);
}

}  // namespace vins
