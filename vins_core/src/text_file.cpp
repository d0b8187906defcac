#include "vins_core/text_file.h"

#include <cstdio>
#include <fstream>

#include "vins_core/input_error.h"

namespace vins {

void writeTextFile(const std::string& path, const std::string& text) {
  const std::string aside = path + ".part";
  std::ofstream out(aside, std::ios::binary);
  out << text << std::flush;
  out.close();
  if (!out || std::rename(aside.c_str(), path.c_str()) != 0) {
    std::remove(aside.c_str());
    throw InputError(path + ": cannot be written");
  }
}

}  // namespace vins
