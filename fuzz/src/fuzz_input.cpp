#include "fuzz_input.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "vins_core/input_error.h"

namespace vins::fuzz {

std::uint8_t Bytes::byte() {
  if (size_ == 0) return 0;
  --size_;
  return *data_++;
}

std::uint32_t Bytes::uint16() {
  const std::uint32_t low = byte();
  return low | (std::uint32_t{byte()} << 8);
}

std::vector<std::uint8_t> Bytes::rest() {
  std::vector<std::uint8_t> bytes(data_, data_ + size_);
  size_ = 0;
  return bytes;
}

void expectResultOrInputError(const std::function<void()>& parse) {
  try {
    parse();
  } catch (const InputError& error) {
    if (std::string(error.what()).empty()) std::abort();
  }
}

FuzzFolder::FuzzFolder() {
  const char* memory = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
  path_ = std::string(memory) + "/vins_fuzz_" + std::to_string(getpid());
  std::filesystem::create_directories(path_);
}

FuzzFolder::~FuzzFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string FuzzFolder::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path(name), std::ios::binary) << bytes;
  return path(name);
}

void FuzzFolder::remove(const std::string& name) const { std::filesystem::remove(path(name)); }

std::string textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace vins::fuzz
