#include "place/binary_file.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "vins_core/input_error.h"

namespace vins::pose_graph {

std::string readBytes(const std::string& path) {
  std::error_code error;  // also where the name is none that the file system takes
  if (!std::filesystem::is_regular_file(path, error)) throw InputError(path + ": is no file");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const std::streamoff length = in.tellg();
  std::string bytes(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  in.seekg(0);
  if (!in.read(bytes.data(), length)) throw InputError(path + ": cannot be read");
  return bytes;
}

std::uint64_t checksum(const char* bytes, std::size_t count, std::uint64_t start) {
  std::uint64_t hash = start;
  for (std::size_t i = 0; i < count; ++i) {
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3U;
  }
  return hash;
}

}  // namespace vins::pose_graph
