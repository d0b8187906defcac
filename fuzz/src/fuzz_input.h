#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vins::fuzz {

/// Takes values off the front of a fuzzer's bytes; zeros behind their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t byte();
  std::uint32_t uint16();
  std::vector<std::uint8_t> rest();

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Calls `parse`. An InputError with a message is a good answer to bad input; any other exception
/// ends the program, which fuzzers take for a finding, and so does an InputError without a message.
void expectResultOrInputError(const std::function<void()>& parse);

/// A folder of files in memory, removed at the end.
class FuzzFolder {
 public:
  FuzzFolder();
  ~FuzzFolder();
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;

  std::string path(const std::string& name) const { return path_ + "/" + name; }

  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  void remove(const std::string& name) const;

 private:
  std::string path_;
};

std::string textOf(const std::uint8_t* data, std::size_t size);

}  // namespace vins::fuzz
