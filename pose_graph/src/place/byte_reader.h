#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "vins_core/input_error.h"

namespace vins::pose_graph {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are little-endian");

/// Takes numbers from a file's bytes in turn; never goes past their end.
class ByteReader {
 public:
  /// `name` stands for the file in messages. `bytes` must outlive the reader.
  ByteReader(const std::string& bytes, std::string name)
      : ByteReader(bytes.data(), bytes.size(), 0, std::move(name)) {}

  /// Of `count` bytes that begin `offset` bytes into the file.
  ByteReader(const char* bytes, std::size_t count, std::size_t offset, std::string name)
      : bytes_(bytes), count_(count), offset_(offset), name_(std::move(name)) {}

  template <typename Number>
  Number take() {
    Number number;
    std::memcpy(&number, claim(1, sizeof(Number)), sizeof(Number));
    return number;
  }

  /// Memory is given only where the file is long enough.
  template <typename Number>
  std::vector<Number> takeMany(std::size_t count) {
    const char* from = claim(count, sizeof(Number));
    std::vector<Number> numbers(count);
    if (count > 0) std::memcpy(numbers.data(), from, count * sizeof(Number));
    return numbers;
  }

  /// The next `count` bytes as a part of its own, which messages call `name`.
  ByteReader takePart(std::size_t count, const std::string& name) {
    const std::size_t offset = offset_ + at_;
    const char* from = claim(count, 1);
    return {from, count, offset, name};
  }

  std::size_t left() const { return count_ - at_; }

  /// All bytes, those taken too.
  const char* data() const { return bytes_; }
  std::size_t size() const { return count_; }

  /// Throws InputError: file, place, and what is wrong there.
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ": at byte " + std::to_string(offset_ + at_) + ": " + what);
  }

 private:
  const char* claim(std::size_t count, std::size_t size) {
    if (count > left() / size) {
      fail("the file ends early; " + std::to_string(count) + " x " + std::to_string(size) +
           " bytes were to come, " + std::to_string(left()) + " are there");
    }
    const char* from = bytes_ + at_;
    at_ += count * size;
    return from;
  }

  const char* bytes_;
  std::size_t count_;
  std::size_t offset_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace vins::pose_graph
